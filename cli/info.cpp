#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "dreampm/backend/cpu/cpu.h"
#include "dreampm/backend/gpu/cuda/cuda.h"
#include "dreampm/backend/registry.h"
#include "dreampm/pipeline/fill_report.h"
#include "dreampm/render/denoise.h"
#include "verbs.h"

namespace dreampm::cli {
namespace {
using Json = nlohmann::ordered_json;

struct Shown {
  std::string operator()(const std::string& text) const { return text; }
  std::string operator()(std::uint64_t n) const { return grouped(n); }
  std::string operator()(double x) const { return fmt::format("{:.6g}", x); }
};

Json vector(const Vec3d& v) { return {v.x, v.y, v.z}; }

void print_json(const Inspection& i) {
  Json json;
  json["kind"] = i.kind;
  json["count"] = i.count;
  if (i.bounds) json["bounds"] = {{"min", vector(i.bounds->min)}, {"max", vector(i.bounds->max)}};
  json["attributes"] = i.attributes;
  if (i.mass) json["mass"] = *i.mass;
  if (i.momentum) json["momentum"] = vector(*i.momentum);
  if (i.volume) json["volume"] = *i.volume;
  if (i.state_hash) json["state_hash"] = *i.state_hash;
  if (!i.by_material.empty()) json["materials"] = i.by_material;
  for (const auto& [name, value] : i.facts) std::visit([&](const auto& v) { json[name] = v; }, value);
  fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
}

/// Six digits of what lies between the ends of the box.
std::string bounds_text(const Box3d& box) {
  double far = 0, size = 0;
  for (int a = 0; a < 3; ++a) {
    far = std::max({far, std::abs(box.min[a]), std::abs(box.max[a])});
    size = std::max(size, box.max[a] - box.min[a]);
  }
  const int digits = size > 0 ? std::clamp(6 + static_cast<int>(std::log10(far / size)), 6, 17) : 6;
  const auto text = [&](const Vec3d& v) {
    return fmt::format("[{:.{}g}, {:.{}g}, {:.{}g}]", v.x, digits, v.y, digits, v.z, digits);
  };
  return text(box.min) + " to " + text(box.max) + " m";
}

void print_text(const Inspection& i) {
  const auto line = [](const std::string& name, const std::string& value) { fmt::print("{:<16} {}\n", name, value); };
  const auto text = [](const Vec3d& v) { return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", v.x, v.y, v.z); };
  line("kind", i.kind);
  line("count", grouped(i.count));
  if (i.bounds) line("bounds", bounds_text(*i.bounds));
  std::string names;
  for (const std::string& a : i.attributes) names += (names.empty() ? "" : ", ") + a;
  if (!names.empty()) line("attributes", names);
  if (i.mass) line("mass", fmt::format("{:.6g} kg", *i.mass));
  if (i.momentum) line("momentum", text(*i.momentum) + " kg m/s");
  if (i.volume) line("volume", fmt::format("{:.6g} m^3", *i.volume));
  if (i.state_hash) line("state_hash", *i.state_hash);
  for (const auto& [name, count] : i.by_material) line(name, grouped(count) + " particles");
  for (const auto& [name, value] : i.facts) line(name, std::visit(Shown{}, value));
}

void print_fill_json(const FrameFill& fill) {
  Json all = Json::array();
  for (const FillReport& r : fill.reports) {
    Json pockets = Json::array();
    for (const Pocket& p : r.pockets) pockets.push_back({{"at", vector(p.at)}, {"m3", p.volume}});
    all.push_back({{"collider", r.collider},
                   {"frame", fill.frame},
                   {"time", fill.time},
                   {"reachable_m3", r.reachable},
                   {"filled_m3", r.filled},
                   {"fraction", r.fraction},
                   {"leaked_m3", r.leaked},
                   {"pockets", pockets}});
  }
  Json json;
  json["fill"] = all[0];
  if (all.size() > 1) json["others"] = Json(all.begin() + 1, all.end());
  fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
}

void print_fill_text(const FrameFill& fill) {
  fmt::print("frame {}, {:.6g} s\n", fill.frame, fill.time);
  for (const FillReport& r : fill.reports) {
    fmt::print("{:<16} {:.4g} of {:.4g} m^3, {:.1f} %\n", r.collider, r.filled, r.reachable, 100 * r.fraction);
    fmt::print("{:<16} {:.4g} m^3\n", "  leaked", r.leaked);
    for (const Pocket& p : r.pockets)
      fmt::print("{:<16} {:.4g} m^3 at [{:.4g}, {:.4g}, {:.4g}]\n", "  pocket", p.volume, p.at.x, p.at.y, p.at.z);
  }
}

/// What this program is, and what it finds on this machine.
int print_program(bool json) {
  const MachineRecord machine = this_machine(std::string(cpu_instruction_sets().back()), thread_count());
  const DenoiserState denoiser = find_denoiser();
  const gpu::CudaState cuda = gpu::find_cuda();
  if (json) {
    Json j;
    j["kind"] = "program";
    j["version"] = version;
    j["commit"] = commit;
    j["cpu"] = machine.cpu;
    j["isa"] = machine.isa;
    j["threads"] = machine.threads;
    j["memory_bytes"] = machine_memory_bytes();
    j["gpu"] = {{"found", cuda.found}, {"text", cuda.text}};
    j["denoiser"] = {{"found", denoiser.found}, {"text", denoiser.text}};
    fmt::print("{}\n", j.dump(2, ' ', false, Json::error_handler_t::replace));
    return 0;
  }
  const auto line = [](const std::string& name, const std::string& value) { fmt::print("{:<16} {}\n", name, value); };
  line("kind", "program");
  line("version", fmt::format("{} ({})", version, commit));
  line("cpu", fmt::format("{}, {}", machine.cpu, machine.isa));
  line("threads", fmt::format("{}", machine.threads));
  line("memory", bytes_text(machine_memory_bytes()));
  line("gpu", cuda.text);
  line("denoiser", denoiser.text);
  return 0;
}

int print_device(bool json) {
  const gpu::CudaState cuda = gpu::find_cuda();
  if (json) {
    Json j{{"kind", "device"}, {"found", cuda.found}, {"text", cuda.text}};
    if (cuda.found) {
      const DeviceFacts device = backend_info("cuda").device();
      j["name"] = device.about, j["free_bytes"] = device.free, j["memory_bytes"] = device.all;
    }
    fmt::print("{}\n", j.dump(2));
  } else
    fmt::print("{}\n", cuda.text);
  return cuda.found ? 0 : 1;
}

}  // namespace

void add_info(CLI::App& app, Action& action) {
  struct Arguments {
    std::string path;
    bool json = false, fill = false, device = false;
    std::optional<int> frame;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App* verb =
      add_verb(app, "info",
               "Say what a scene, mesh, particle file, checkpoint or run's folder holds; without one, what "
               "this program finds on the machine",
               "dreampm info out/dam-break/particles/particles_000001.ply");
  verb->add_option("PATH", a->path, "a file, a run's folder or asset:NAME");
  verb->add_flag("--json", a->json, "print JSON");
  CLI::Option* fill = verb->add_flag("--fill", a->fill, "of a run: how full its containers are");
  verb->add_flag("--device", a->device, "only which GPU `--backend cuda` would use; exit code 1 where there is none")
      ->excludes(fill);
  verb->add_option("--frame", a->frame, "with --fill: that frame, not the last")->needs(fill);
  verb->callback([a, &action] {
    action = [a] {
      if (a->device) {
        if (!a->path.empty()) fail_input("--device is of this machine; name no {}", a->path);
        return print_device(a->json);
      }
      if (a->path.empty()) {
        if (a->fill) fail_input("--fill is of a run's folder; name one");
        return print_program(a->json);
      }
      if (a->fill) {
        const FrameFill found = frame_fill(open_run(a->path), a->frame);
        a->json ? print_fill_json(found) : print_fill_text(found);
        return 0;
      }
      const Inspection i = inspect(a->path);
      a->json ? print_json(i) : print_text(i);
      return 0;
    };
  });
}

}  // namespace dreampm::cli
