#include <array>
#include <charconv>
#include <map>
#include <optional>

#include "dreampm/pipeline/compare_pictures.h"
#include "verbs.h"

namespace dreampm::cli {
namespace {

struct RenderArguments {
  std::vector<std::string> names;
  std::string range, up = "y", crop, out;
  int frame = 0, threads = 0, turntable = 0;
  bool compare = false;
  RenderOptions options;
  LoosePictures loose;
  std::vector<std::string> of_files, of_runs;  ///< options given that only files, or runs, take
};

/// Of "x0,y0,x1,y1"; nothing of other text.
std::optional<PixelBox> pixel_box(const std::string& text) {
  std::array<int, 4> n{};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t i = 0; i < n.size(); ++i) {
    const auto [next, error] = std::from_chars(at, end, n[i]);
    const bool last = i + 1 == n.size();
    if (error != std::errc{} || (last ? next != end : next == end || *next != ',')) return std::nullopt;
    at = last ? end : next + 1;
  }
  return PixelBox{n[0], n[1], n[2], n[3]};
}

CLI::Validator box_of_pixels() {
  const auto check = [](const std::string& text) {
    if (pixel_box(text)) return std::string();
    return fmt::format("'{}' is no box; give X0,Y0,X1,Y1, pixels from the upper left, as 600,200,1000,480", text);
  };
  return CLI::Validator(check, {});
}

void print_names(const std::vector<std::filesystem::path>& files) {
  for (const std::filesystem::path& f : files) fmt::print("{}\n", f.string());
}

std::filesystem::path out_folder(const RenderArguments& a, const std::filesystem::path& otherwise) {
  return a.out.empty() ? otherwise : std::filesystem::path(a.out);
}

int render_run(const RenderArguments& a, const RenderOptions& options) {
  if (!a.crop.empty() || a.turntable > 0) {
    const RunFolder run = open_run(a.names[0]);
    if (!a.crop.empty())
      print_names(render_part(run, options, *pixel_box(a.crop), out_folder(a, run.folder / "crop")));
    else
      print_names(render_turntable(run, a.frame, a.turntable, options.wishes, out_folder(a, run.folder / "turntable")));
    return 0;
  }
  if (!a.out.empty())
    fail_input("--out is for files, parts, turntables and comparisons; a run's pictures go to DIR/render");
  RunFolder run = open_run(a.names[0], Access::write);
  if (render_stage(run, options).made == 0) info("nothing to do: {} is up to date", (run.folder / "render").string());
  if (a.frame > 0) fmt::print("{}\n", picture_file(run, a.frame).string());
  return 0;
}

int compare(const RenderArguments& a, const RenderOptions& options) {
  if (a.names.size() != 2) fail_input("--compare is of two runs or two pictures; {} are given", a.names.size());
  for (const Comparison& c :
       compare_pictures(a.names[0], a.names[1], out_folder(a, "compare"), options.first, options.last)) {
    const PictureDifference& d = c.difference;
    fmt::print("{}: root mean square {:.6f}, mean {:.6f}, most {:.6f}, {:.2f} % of the pixels differ\n{}\n", c.name,
               d.rms, d.mean, d.most, 100 * d.share, c.shown.string());
  }
  return 0;
}

int render_frames(const RenderArguments& a) {
  const ThreadLimit limit(a.threads);
  RenderOptions options = a.options;
  if (a.frame > 0) options.first = options.last = a.frame;
  if (!a.range.empty()) std::tie(options.first, options.last) = frame_range(a.range);
  if (a.compare) return compare(a, options);
  if (names_run(a.names, a.of_files)) return render_run(a, options);
  if (!a.of_runs.empty())
    fail_input("{} is for a run's folder; of files name those that are to be drawn", a.of_runs[0]);
  LoosePictures request = a.loose;
  request.files = a.names;
  request.up = ups().at(a.up);
  request.wishes = options.wishes;
  request.out = out_folder(a, request.out);
  if (!a.crop.empty()) request.crop = *pixel_box(a.crop);
  print_names(render_files(request));
  return 0;
}

/// The options of files; names_run refuses them of a run.
std::vector<CLI::Option*> add_of_files(CLI::App& verb, RenderArguments& a) {
  return {
      verb.add_option("--look", a.loose.look,
                      "of files: water, glass, clay, plastic or metal (default: water for closed meshes, else clay)")
          ->check(CLI::IsMember(picture_looks())),
      verb.add_option("--spacing", a.loose.spacing,
                      "of files: the distance between particles, in their unit (default: as they lie)")
          ->check(number_in(1e-9, 1e9)),
      verb.add_option("--up", a.up, "of files: the axis that points up in them, y or z")
          ->check(CLI::IsMember(ups()))
          ->capture_default_str(),
      verb.add_option("--azimuth", a.loose.azimuth, "of files: where the camera stands [degrees]")
          ->capture_default_str()
          ->check(number_in(-360, 360)),
      verb.add_option("--elevation", a.loose.elevation, "of files: how high it stands [degrees]")
          ->capture_default_str()
          ->check(number_in(-89, 89))};
}

}  // namespace

void add_render(CLI::App& app, Action& action) {
  auto a = std::make_shared<RenderArguments>();
  CLI::App* verb =
      add_verb(app, "render", "Draw the frames of a run, or files of meshes or particles; compare pictures",
               "dreampm render out/dragon-splatting-preview --frame 60 --scale 2 --samples 64\n"
               "dreampm render out/dragon-splatting-preview --frame 60 --crop 800,300,1100,500\n"
               "dreampm render meshes/*.ply --look water\n"
               "dreampm render --compare out/a out/b --frame 60");
  verb->add_option("DIR", a->names, "a run's folder with its surfaces; or files of meshes or particles, each a frame")
      ->required();
  auto* one = verb->add_option("--frame", a->frame, "of a run: only this frame")->transform(whole_number(1, 1000000));
  auto* some =
      verb->add_option("--frames", a->range, "of a run: only frames A-B, or A:B, both included")->excludes(one);
  PictureWishes& wishes = a->options.wishes;
  std::vector<CLI::Option*> of_drawing{
      verb->add_option("--scale", wishes.scale, "of the picture's size (files: of 1280 x 720)")
          ->check(number_in(0.01, 4)),
      verb->add_option("--samples", wishes.samples, "at most, a pixel (default: the scene's; files: 32)")
          ->transform(whole_number(2, 65536)),
      verb->add_flag("--exr", wishes.exr,
                     "beside each PNG an OpenEXR file: linear light, depth, normals, albedo, motion vectors"),
      verb->add_flag("--denoise", wishes.denoise, "take noise out by Open Image Denoise, which is installed apart")};
  auto* crop = verb->add_option("--crop", a->crop,
                                "draw only the pixels X0,Y0,X1,Y1 from the upper left, X1 and Y1 not included, as the "
                                "whole picture has them (of a run: to DIR/crop)")
                   ->check(box_of_pixels());
  auto* table = verb->add_option("--turntable", a->turntable,
                                 "of a run, with --frame: this many pictures from a circle round it, to DIR/turntable")
                    ->transform(whole_number(1, 100000))
                    ->needs(one)
                    ->excludes(crop);
  auto* compared =
      verb->add_flag("--compare", a->compare,
                     "put pictures of two runs, or two PNG or EXR files, beside each other with their difference, and "
                     "print how large it is");
  const std::vector<CLI::Option*> of_files = add_of_files(*verb, *a);
  of_drawing.insert(of_drawing.end(), {crop, table});
  of_drawing.insert(of_drawing.end(), of_files.begin(), of_files.end());
  for (CLI::Option* o : of_drawing) compared->excludes(o);
  verb->add_option("--out", a->out, "the folder of pictures (default: render for files, compare for comparisons)");
  add_threads(*verb, a->threads);
  verb->callback([a, of_files, one, some, table, &action] {
    a->of_files = given(of_files), a->of_runs = given({one, some, table});
    action = [a] { return render_frames(*a); };
  });
}

}  // namespace dreampm::cli
