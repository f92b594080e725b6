#include "dreampm/farm/wedge_sheet.h"

#include <algorithm>
#include <array>

#include "dreampm/base/log.h"
#include "dreampm/io/png.h"
#include "dreampm/video/contact_sheet.h"
#include "dreampm/video/letters.h"

namespace dreampm::farm {
namespace fs = std::filesystem;
namespace {

using Color = std::array<std::uint8_t, 3>;
constexpr Color bright{235, 235, 235}, dim{160, 170, 180};
constexpr std::uint8_t ground = 24;
constexpr int sheet_columns = 4, gap = 6, widest_tile = 320;
constexpr std::size_t most_rows = 12;

/// The pictures of a run that are shown, by frame.
std::vector<fs::path> pictures_of(const fs::path& run, std::size_t count) {
  std::vector<fs::path> all;
  if (fs::is_directory(run / "render"))
    for (const auto& entry : fs::directory_iterator(run / "render"))
      if (entry.path().extension() == ".png") all.push_back(entry.path());
  std::sort(all.begin(), all.end());
  if (count == 1 && !all.empty()) return {all.back()};
  std::vector<fs::path> shown;
  for (const std::size_t i : spread_evenly(all.size(), count)) shown.push_back(all[i]);
  return shown;
}

struct Line {
  std::string text;
  Color color;
};

/// Words in lines of at most `most` letters.
void add_lines(const std::vector<std::string>& words, std::size_t most, const Color& color, std::vector<Line>& lines) {
  std::string line;
  for (std::string word : words) {
    if (word.size() > most) word = word.substr(0, most - 2) + "..";
    if (!line.empty() && line.size() + 2 + word.size() > most) lines.push_back({line, color}), line.clear();
    line += (line.empty() ? "" : "  ") + word;
  }
  if (!line.empty()) lines.push_back({line, color});
}

/// A run on the sheet: its letters above its pictures.
struct Cell {
  std::vector<Line> lines;
  std::vector<RgbImage> tiles;
};

class Sheet {
 public:
  Sheet(const Wedge& wedge, const std::vector<WedgeRow>& rows, const fs::path& folder)
      : pictures_(rows.size() <= most_rows ? sheet_columns : 1), across_(sheet_columns / pictures_) {
    std::vector<std::vector<fs::path>> files;
    for (const WedgeRun& run : wedge.runs) {
      files.push_back(pictures_of(folder / run.name, static_cast<std::size_t>(pictures_)));
      some_ = some_ || !files.back().empty();
    }
    const int tile_width = width_of_tiles(files);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      Cell& cell = cells_.emplace_back();
      for (const fs::path& file : files[r]) cell.tiles.push_back(shrink(read_png(file), tile_width));
      if (!Letters::there()) continue;
      const auto most = static_cast<std::size_t>(std::max(8, cell_width(tile_width) / letters_.advance()));
      add_lines(wedge.runs[r].settings(wedge.keys), most, bright, cell.lines);
      add_lines(measured_words(rows[r]), most, dim, cell.lines);
    }
    tile_width_ = tile_width;
  }

  bool has_pictures() const { return some_; }

  RgbImage drawn() const {
    int height = gap;
    for (std::size_t row = 0; row * across() < cells_.size(); ++row) height += row_height(row) + gap;
    RgbImage sheet(gap + across_ * (cell_width(tile_width_) + gap), std::min(height, widest_png));
    std::fill(sheet.pixels.begin(), sheet.pixels.end(), ground);
    int top = gap;
    for (std::size_t row = 0; row * across() < cells_.size(); ++row) {
      for (std::size_t c = 0; c < across() && row * across() + c < cells_.size(); ++c)
        draw(cells_[row * across() + c], gap + static_cast<int>(c) * (cell_width(tile_width_) + gap), top,
             letters_height(row), sheet);
      top += row_height(row) + gap;
    }
    return sheet;
  }

 private:
  std::size_t across() const { return static_cast<std::size_t>(across_); }
  int cell_width(int tile_width) const { return pictures_ * (tile_width + gap) - gap; }

  /// What is there or less, and so much less that a PNG holds all rows of pictures.
  int width_of_tiles(const std::vector<std::vector<fs::path>>& files) const {
    int width = 1;
    double tallest = 0;  // over its width
    for (const auto& run : files)
      if (!run.empty()) {
        const RgbImage first = read_png(run[0]);
        width = std::max(width, std::min(widest_tile, first.width));
        tallest = std::max(tallest, double(first.height) / first.width);
      }
    const double rows = std::max(1.0, double(files.size()) / across_), letters = 6.0 * letters_.line_height();
    const double room = double(widest_png) / rows - gap - letters;
    return tallest > 0 ? std::clamp(static_cast<int>(room / tallest), 1, width) : width;
  }

  template <class Height>
  int most_of(std::size_t row, const Height& height) const {
    int most = 0;
    for (std::size_t c = row * across(); c < std::min(cells_.size(), (row + 1) * across()); ++c)
      most = std::max(most, height(cells_[c]));
    return most;
  }
  int letters_height(std::size_t row) const {
    return most_of(row, [&](const Cell& c) { return static_cast<int>(c.lines.size()) * letters_.line_height(); });
  }
  int row_height(std::size_t row) const {
    return letters_height(row) + most_of(row, [](const Cell& c) {
             int tallest = 0;
             for (const RgbImage& tile : c.tiles) tallest = std::max(tallest, tile.height);
             return tallest;
           });
  }

  void draw(const Cell& cell, int left, int top, int letters, RgbImage& sheet) const {
    for (std::size_t l = 0; l < cell.lines.size(); ++l)
      letters_.draw(sheet, left, top + static_cast<int>(l) * letters_.line_height(), cell.lines[l].text,
                    cell.lines[l].color);
    for (std::size_t t = 0; t < cell.tiles.size(); ++t) {
      const RgbImage& tile = cell.tiles[t];
      const int x = left + static_cast<int>(t) * (tile_width_ + gap), y = top + letters;
      for (int v = 0; v < tile.height && y + v < sheet.height; ++v)
        std::copy_n(tile.at(0, v), tile.width * 3, sheet.at(x, y + v));
    }
  }

  Letters letters_;
  int pictures_, across_;
  int tile_width_ = 1;
  bool some_ = false;
  std::vector<Cell> cells_;
};

}  // namespace

bool write_wedge_sheet(const Wedge& wedge, const std::vector<WedgeRow>& rows, const fs::path& folder,
                       const fs::path& file) {
  const Sheet sheet(wedge, rows, folder);
  if (!sheet.has_pictures()) return false;
  if (!Letters::there())
    warn("{}: without letters, because this build has no Dear ImGui; its rows are those of the table", file.string());
  write_png(file, sheet.drawn());
  return true;
}

}  // namespace dreampm::farm
