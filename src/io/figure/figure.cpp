#include "io/figure/figure.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <fstream>
#include <iterator>

#include "io/file/process.hpp"
#include "io/file/write_file.hpp"
#include "sinew/io/table.hpp"
#include "sinew/kernel/crc32.h"

namespace sinew::inline v1 {
namespace {

namespace fs = std::filesystem;

/// Cairo writes the time into a PDF; without it the same figure is the same file.
void remove_date(std::string& pdf) {
  constexpr std::string_view mark = "/CreationDate (D:", epoch = "19700101000000";
  const std::size_t place = pdf.find(mark);
  if (place == std::string::npos || place + mark.size() + epoch.size() > pdf.size()) return;
  pdf.replace(place + mark.size(), epoch.size(), epoch);
}

/// Its width and height on paper; else what shows it chooses them.
void set_size(std::string& svg, const PageLayout& page) {
  constexpr double mm = 25.4 / 72;  // a point
  const std::size_t place = svg.find(" viewBox=");
  if (place == std::string::npos) return;
  svg.insert(place, fmt::format(" width=\"{:.6g}mm\" height=\"{:.6g}mm\"\n", page.unit * page.width * mm,
                                page.unit * page.height * mm));
}

/// 300 pixels an inch, after the header: programs then place it at its width on paper.
void set_resolution(std::string& png) {
  constexpr std::size_t header = 33;  // signature and IHDR
  constexpr std::uint32_t a_metre = 11811;
  if (png.size() < header) return;
  const auto number = [](std::uint32_t value) {
    std::string bytes;
    for (const unsigned shift : {24U, 16U, 8U, 0U}) bytes += static_cast<char>(value >> shift & 0xffU);
    return bytes;
  };
  const std::string chunk = "pHYs" + number(a_metre) + number(a_metre) + '\1';
  kernel::Crc32 sum;
  sum.add_text(chunk);
  png.insert(header, number(9) + chunk + number(sum.value()));
}

/// The bytes of one format. gnuplot reads from memory and writes into a pipe: it opens no file, so that no
/// name is one for it to take apart, and a full disc is for us to notice.
Expected<std::string> draw(const Figure& figure, FigureFormat format, FigureOptions options,
                           const fs::path& script) {
  options.formats = {format};
  // -d: nobody's ~/.gnuplot changes the figure.
  ProcessResult outcome =
      run_process({options.gnuplot, "-d", "/dev/stdin"}, ".", gnuplot_script(figure, {}, options));
  if (outcome.is_missing())
    return failure(
        "gnuplot_missing", script.string(),
        "gnuplot is not installed: apt-get install gnuplot-nox (the script is written; run it with "
        "gnuplot to draw the figure)");
  if (outcome.spawn_error != 0)
    return failure("gnuplot_failed", script.string(), "gnuplot cannot be started: " + outcome.complaint());
  if (!outcome.succeeded() || outcome.output.empty())
    return failure("gnuplot_failed", script.string(), "gnuplot could not draw it: " + outcome.complaint());
  if (format == FigureFormat::pdf) remove_date(outcome.output);
  if (format == FigureFormat::svg && options.width > 0) set_size(outcome.output, page_of(figure, options));
  if (format == FigureFormat::png && options.width > 0) set_resolution(outcome.output);
  return std::move(outcome.output);
}

/// A script that a person changed is worth more than a figure.
Expected<void> spare(const fs::path& script) {
  std::error_code code;
  const fs::file_status status = fs::status(script, code);
  if (!fs::exists(status)) return {};
  if (fs::is_regular_file(status)) {
    std::ifstream file(script, std::ios::binary);
    if (is_as_written(std::string(std::istreambuf_iterator<char>(file), {}))) return {};
  }
  return failure(
      "script_edited", script.string(),
      "is not as sinew wrote it, and would be lost; draw it with gnuplot as it is, give the figure another "
      "name, or remove it (the command replaces it with --force)");
}

}  // namespace

Expected<std::vector<fs::path>> write_figure(const Figure& figure, const fs::path& stem,
                                             const FigureOptions& options) {
  std::vector<fs::path> paths{fs::path(stem) += ".gp"};
  if (!options.replaces_edited_script)
    if (auto spared = spare(paths.front()); !spared) return tl::unexpected(std::move(spared.error()));
  std::vector<std::string> texts{gnuplot_script(figure, stem.filename().string(), options)};
  for (const FigureFormat format : options.formats) {
    auto drawn = draw(figure, format, options, paths.front());
    if (!drawn) {
      if (auto written = write_text(texts.front(), paths.front()); !written)
        return tl::unexpected(std::move(written.error()));
      return tl::unexpected(std::move(drawn.error()));
    }
    paths.push_back(fs::path(stem) += fmt::format(".{}", extension(format)));
    texts.push_back(std::move(*drawn));
  }
  std::vector<FileWriter> files;
  for (std::size_t k = 0; k < paths.size(); ++k) {
    auto file = FileWriter::open(paths[k]);
    if (!file) return tl::unexpected(std::move(file.error()));
    if (auto done = file->write(texts[k]); !done) return tl::unexpected(std::move(done.error()));
    files.push_back(std::move(*file));
  }
  if (auto done = finish_together(files); !done) return tl::unexpected(std::move(done.error()));
  return paths;
}

}  // namespace sinew::inline v1
