// The real window on a display of its own: keys and clicks by xdotool arrive as what app_test.cpp
// checks one by one.
#include "dreampm/play/window/window.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "dreampm/base/file.h"
#include "dreampm/gl/headless.h"
#include "dreampm/play/model/solver_choice.h"
#include "dreampm/play/window/app.h"
#include "dreampm/play/window/view.h"
#include "play/ask_to_close.h"
#include "play/small_scene.h"

namespace dreampm::play::window_test {
namespace {
using namespace test;
using testing::Contains;
using testing::Not;
using testing::StartsWith;

void sleep(int milliseconds) { std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds)); }

/// A program that runs beside the test, in the folder of what it says, and ends with it.
class Beside {
 public:
  Beside(std::vector<std::string> words, const std::string& errors) {
    pid_ = ::fork();
    if (pid_ != 0) return;
    const int file = ::open(errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    ::dup2(file, 1), ::dup2(file, 2);
    if (::chdir(std::filesystem::path(errors).parent_path().c_str()) != 0) ::_exit(126);
    std::vector<char*> line;
    for (std::string& w : words) line.push_back(w.data());
    line.push_back(nullptr);
    ::execvp(line[0], line.data());
    ::_exit(127);
  }
  ~Beside() {
    if (pid_ > 0) ::kill(pid_, SIGKILL), wait(5000);
  }
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;

  void signal(int number) const { ::kill(pid_, number); }
  /// Its exit code, or -1 where it does not end in that time.
  int wait(int milliseconds) {
    int status = 0;
    for (int n = 0; n < milliseconds / 20; ++n, sleep(20))
      if (::waitpid(pid_, &status, WNOHANG) == pid_) {
        pid_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
      }
    return -1;
  }

 private:
  pid_t pid_;
};

bool has(const char* program) {
  return std::system(fmt::format("command -v {} >/dev/null 2>&1", program).c_str()) == 0;
}

class Window : public testing::Test {
 protected:
  static constexpr int width = 800, height = 600;
  /// ms, of what takes less than one on an idle machine.
  static constexpr int longest_wait = 60000;

  void SetUp() override {
    for (const char* program : {"Xvfb", "xdotool"})
      ASSERT_TRUE(has(program)) << program << " is missing: tools/packages.txt names what tests need";
    folder = std::filesystem::path(testing::TempDir()) / fmt::format("window-{}", ::getpid());
    std::filesystem::create_directories(folder);
    serve("1280x720");
  }
  /// The server takes a free display, and writes its number where it is ready.
  void serve(const std::string& screen) {
    server.reset();
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    server = std::make_unique<Beside>(std::vector<std::string>{"Xvfb", "-displayfd", std::to_string(ends[1]), "-screen",
                                                               "0", screen + "x24", "-nolisten", "tcp"},
                                      (folder / "server").string());
    ::close(ends[1]);
    char number[16] = {};
    const auto read = ::read(ends[0], number, sizeof number - 1);
    ::close(ends[0]);
    ASSERT_GT(read, 0) << read_file(folder / "server");
    ::setenv("DISPLAY", fmt::format(":{}", std::stoi(number)).c_str(), 1);
    ::unsetenv("WAYLAND_DISPLAY");
  }
  void TearDown() override {
    player.reset();
    server.reset();
    ::unsetenv("DISPLAY");
    if (!folder.empty()) std::filesystem::remove_all(folder);
  }

  void play(const std::string& what) {
    player = std::make_unique<Beside>(
        std::vector<std::string>{DM_COMMAND, "play", what, "--size", fmt::format("{}x{}", width, height), "--particles",
                                 "medium", "--record", record().string()},
        (folder / "said").string());
    ASSERT_TRUE(type("search --sync --onlyvisible --name DreaMPM")) << read_file(folder / "said");
    // It listens where it draws: a picture shows that it does, and how fast.
    using Clock = std::chrono::steady_clock;
    const auto began = Clock::now();
    const auto is_there = [&](int number) {
      return std::filesystem::exists(folder / fmt::format("dreampm-{:03}.png", number));
    };
    int asked_for = 0;
    for (auto asked = began - std::chrono::seconds(2); !is_there(1); sleep(10)) {
      ASSERT_LT(Clock::now() - began, std::chrono::milliseconds(longest_wait)) << read_file(folder / "said");
      if (Clock::now() - asked < std::chrono::seconds(2)) continue;
      ASSERT_TRUE(type("key F12"));
      ++asked_for, asked = Clock::now();
    }
    // Those that it was asked for before it listened may come late, or, in one picture, as one.
    rest(asked_for > 1 ? 2000 : 0);
    int next = 2;
    while (is_there(next)) ++next;
    patience = 1;
    const auto again = Clock::now();
    ASSERT_TRUE(type("key F12"));
    while (!is_there(next)) {
      ASSERT_LT(Clock::now() - again, std::chrono::milliseconds(longest_wait)) << read_file(folder / "said");
      sleep(10);
    }
    patience = std::clamp(std::chrono::duration<double>(Clock::now() - again).count() / draws_in, 1.0, 10.0);
    rest(700);
  }
  /// Longer where the machine is busy.
  void rest(int milliseconds) const { sleep(static_cast<int>(milliseconds * patience)); }
  /// With some time for the window to take it in.
  bool type(const std::string& words) const {
    const int status =
        std::system(fmt::format("timeout 20 xdotool {} >'{}' 2>&1", words, (folder / "tool").string()).c_str());
    rest(120);
    return status == 0;
  }
  /// Types it again while the record has no such line: what a window shows late it takes late.
  bool press_until_recorded(const std::string& words, const std::string& line) const {
    for (int n = 0; n < 10; ++n) {
      if (!type(words)) return false;
      for (int wait = 0; wait < 20; ++wait, rest(50))
        if (recorded(line) > 0) return true;
    }
    return false;
  }
  /// Ends it by Ctrl-C; the lines that it recorded.
  std::vector<std::string> close() {
    player->signal(SIGINT);
    EXPECT_EQ(player->wait(longest_wait), 130) << read_file(folder / "said");
    std::vector<std::string> lines;
    std::istringstream text(read_file(record()));
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return lines;
  }
  /// A file of the breaking dam by short steps.
  std::string explicit_dam() const {
    const std::filesystem::path file = folder / "dam-break.yaml";
    replace_file_text(file, by_solver(load_play_scene("dam-break"), SolverKind::explicit_steps).scene.yaml());
    return file.string();
  }
  std::filesystem::path record() const { return folder / "record.txt"; }
  /// How many lines of the record begin so, until now.
  std::ptrdiff_t recorded(const std::string& start) const {
    std::istringstream text(read_file(record()));
    std::ptrdiff_t count = 0;
    for (std::string line; std::getline(text, line);) count += line.starts_with(start) ? 1 : 0;
    return count;
  }
  /// Whether the record gets that many lines that begin so, in time.
  bool records(const std::string& start, std::ptrdiff_t times = 1) const {
    for (int n = 0; n < longest_wait / 20 && recorded(start) < times; ++n) sleep(20);
    return recorded(start) >= times;
  }

  std::filesystem::path folder;
  std::unique_ptr<Beside> server, player;
  /// s that a picture takes on two idle cores, and how much longer it took here.
  static constexpr double draws_in = 0.25;
  double patience = 1;
};

/// How often a line stands there.
std::ptrdiff_t count(const std::vector<std::string>& lines, const std::string& line) {
  return std::count(lines.begin(), lines.end(), line);
}

TEST_F(Window, KeysAndClicksArriveAndTheRecordReplays) {
  // Where things stand, by the same panels in a window of that size.
  gl::HeadlessContext context;
  App app([](const Action&) { return std::uint64_t{0}; }, 1, "test", true);
  // By short steps, which all matter goes with.
  const std::string scene = explicit_dam();
  const PlayScene stage = load_play_scene(scene);
  Playground twin(stage, quiet_options());
  Input input;
  for (int n = 0; n < 3; ++n) input.time += 0.02, app.update(*twin.frame(), input, width, height, 1);
  const auto at = [&](const std::string& what, double share) {
    for (const Place& p : app.places())
      if (p.what == what)
        return fmt::format("mousemove {} {}", static_cast<int>(p.left + share * (p.right - p.left)),
                           static_cast<int>((p.top + p.bottom) / 2));
    ADD_FAILURE() << "nothing named " << what;
    return std::string();
  };
  const Place last = *std::find_if(app.places().begin(), app.places().end(),
                                   [](const Place& p) { return p.what == "open dam-break"; });
  const int left = 310, bottom = height - static_cast<int>(last.top) + 60;
  Vec3d middle;
  const std::shared_ptr<const Frame> frame = twin.frame();
  for (const Vec3f& x : frame->matter[0].position) middle += static_cast<Vec3d>(x);
  middle = middle * (1.0 / static_cast<double>(frame->matter[0].position.size()));
  const auto seen = camera_of(*frame).project(static_cast<Vec3f>(middle), width - left, height - bottom);
  ASSERT_TRUE(seen);
  const int x = left + static_cast<int>(seen->x), y = static_cast<int>(seen->y);

  play(scene);
  // The mouse: buttons of the panel, a number typed into a slider, and a hand that pushes.
  for (const auto& [what, share] : {std::pair{"set matter 3", 0.5}, {"set tool 4", 0.5}}) {
    EXPECT_TRUE(type(at(what, share)));
    EXPECT_TRUE(type("click 1"));
    EXPECT_TRUE(records(what)) << what;
  }
  EXPECT_TRUE(type(at("strength", 0.2)));
  // All of it between two pictures of a slow machine.
  EXPECT_TRUE(type("keydown ctrl click 1 keyup ctrl"));
  EXPECT_TRUE(type("type --delay 60 2.5"));
  EXPECT_TRUE(type("key Return"));
  EXPECT_TRUE(records("set strength 2.5"));
  // Keys.
  EXPECT_TRUE(type("key 3"));
  EXPECT_TRUE(records("set matter 2")) << "the key, and not what was typed into the slider";
  EXPECT_TRUE(type("key z key q"));
  EXPECT_TRUE(records("set tool 0"));
  EXPECT_EQ(recorded("undo") + recorded("refused undo"), 0) << "Z alone is none";
  EXPECT_TRUE(type("key ctrl+z"));
  // There is an edit to undo where the pointer met matter on its way. A key that is let go late
  // repeats.
  for (int n = 0; n < longest_wait / 20 && recorded("undo") + recorded("refused undo") == 0; ++n) sleep(20);
  EXPECT_GE(recorded("undo") + recorded("refused undo"), 1);
  for (const char* key : {"F1", "F1", "Tab", "Tab"}) EXPECT_TRUE(type(std::string("key ") + key));
  // A hand over matter that stands still.
  // A click is where the pointer was, however late the window sees it.
  {
    const std::string there = at("set tool 3", 0.5);
    EXPECT_TRUE(type(there + " click 1 " + fmt::format("mousemove {} {}", x, y)));
    EXPECT_TRUE(records("set tool 3"));
    EXPECT_TRUE(type("key q"));
    EXPECT_TRUE(records("set tool 0", 2));
  }
  EXPECT_TRUE(type("key r"));
  EXPECT_TRUE(records("restart"));
  EXPECT_TRUE(type("key space"));
  EXPECT_TRUE(records("set paused 1"));
  for (int n = 0; n < 8; ++n) EXPECT_TRUE(type(fmt::format("mousemove {} {}", x - 30 + 8 * n, y)));
  EXPECT_TRUE(records("push "));
  EXPECT_TRUE(type("key space"));
  EXPECT_TRUE(records("set paused 0"));
  // Two sides are compared for a moment, and a wall is dragged. The other side is chosen once the
  // window shows that there are two.
  EXPECT_TRUE(type("key k"));
  EXPECT_TRUE(records("compare on"));
  EXPECT_TRUE(press_until_recorded("key x", "compare side B"));
  EXPECT_TRUE(type("key k"));
  EXPECT_TRUE(records("compare off"));
  EXPECT_TRUE(type("key w"));
  EXPECT_TRUE(type(fmt::format("mousemove {} {}", x, y)));
  EXPECT_TRUE(type("mousedown 1"));
  for (int n = 1; n < 5; ++n) EXPECT_TRUE(type(fmt::format("mousemove {} {}", x + 10 * n, y - 3 * n)));
  EXPECT_TRUE(records("wall "));
  EXPECT_TRUE(type("mouseup 1"));
  EXPECT_TRUE(type("key q"));
  EXPECT_TRUE(records("set tool 0", 3));
  // A window that loses its focus lets go of the keys: those go to what lies under the pointer.
  EXPECT_TRUE(type("keydown p"));
  EXPECT_TRUE(records("pour ")) << "wherever matter is by now";
  EXPECT_TRUE(type("mousemove 1200 700"));
  EXPECT_TRUE(type("windowfocus 1"));
  EXPECT_TRUE(records("pour off"));
  EXPECT_TRUE(type("keyup p"));
  const std::vector<std::string> lines = close();

  EXPECT_EQ(count(lines, "set matter 3"), 1);
  EXPECT_EQ(count(lines, "set tool 4"), 1);
  EXPECT_EQ(count(lines, "set strength 2.5"), 1);
  EXPECT_EQ(count(lines, "set matter 2"), 1);
  EXPECT_EQ(count(lines, "set tool 0"), 3);
  EXPECT_EQ(count(lines, "set tool 3"), 1);
  EXPECT_EQ(count(lines, "compare on honey"), 1);
  EXPECT_EQ(count(lines, "set paused 1"), 1);
  EXPECT_EQ(count(lines, "set paused 0"), 1);
  EXPECT_EQ(count(lines, "restart"), 1);
  EXPECT_GE(count(lines, "undo") + count(lines, "refused undo"), 1);
  EXPECT_EQ(count(lines, "pour off"), 1);
  // Nothing else was set.
  for (const std::string& line : lines) {
    const bool is_known = line.starts_with("set matter ") || line.starts_with("set tool ") ||
                          line.starts_with("set strength ") || line.starts_with("set paused ");
    EXPECT_TRUE(is_known || !line.starts_with("set ")) << line;
  }
  ASSERT_THAT(lines.back(), StartsWith("# hash "));
  const std::string again = fmt::format("'{}' play '{}' --headless --frames 0 --threads 1 --script '{}' >'{}'",
                                        DM_COMMAND, scene, record().string(), (folder / "again").string());
  ASSERT_EQ(std::system(again.c_str()), 0);
  EXPECT_EQ("# " + read_file(folder / "again"), lines.back() + "\n");
}

/// As a window manager does it: sizes, a window that is not shown, and the button that closes it.
TEST_F(Window, SizesHidingAndClosingAreTaken) {
  play("dam-break");
  const std::string window = "search --name DreaMPM ";
  const auto plays_on = [&] { return records("steps 1", recorded("steps 1") + 2); };
  EXPECT_TRUE(plays_on());
  for (const char* size : {"1 1", "2000 1500", "800 600"}) {
    EXPECT_TRUE(type(window + "windowsize " + size));
    EXPECT_TRUE(plays_on()) << size;
  }
  EXPECT_TRUE(type(window + "windowunmap"));
  EXPECT_TRUE(plays_on());
  EXPECT_TRUE(type(window + "windowmap --sync"));
  EXPECT_TRUE(type("key g")) << read_file(folder / "tool");
  EXPECT_TRUE(records("set tool 1"));
  ASSERT_TRUE(type(window));
  EXPECT_TRUE(ask_to_close(std::stoul(read_file(folder / "tool"))));
  EXPECT_EQ(player->wait(longest_wait), 0) << read_file(folder / "said");
  EXPECT_EQ(recorded("# hash "), 1);
}

TEST_F(Window, TheReportOpensAt1920x1080OrAsLargeAsTheScreen) {
  for (const char* screen : {"1280x720", "1920x1080", "2560x1440"}) {
    serve(screen);
    player =
        std::make_unique<Beside>(std::vector<std::string>{DM_COMMAND, "play", "report"}, (folder / "said").string());
    ASSERT_TRUE(type("search --sync --onlyvisible --name DreaMPM getwindowgeometry")) << read_file(folder / "said");
    const std::string size = std::string(screen) == "1280x720" ? screen : "1920x1080";
    EXPECT_THAT(read_file(folder / "tool"), testing::HasSubstr("Geometry: " + size));
    player.reset();
  }
}

TEST_F(Window, ClosesWhileALongTickRuns) {
  // Opening the dragon takes its time: the window is closed in the middle of that.
  play("dragon-rain");
  EXPECT_TRUE(type("key r"));
  EXPECT_TRUE(records("restart"));
  EXPECT_THAT(close().back(), StartsWith("# hash "));
}

}  // namespace
}  // namespace dreampm::play::window_test
