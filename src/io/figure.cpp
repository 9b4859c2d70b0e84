#include "sinew/io/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "sinew/io/process.hpp"
#include "sinew/io/table.hpp"

namespace sinew::inline v0 {
namespace {

namespace fs = std::filesystem;

Expected<void> draw(const fs::path& script, const std::string& gnuplot) {
  const fs::path folder = script.has_parent_path() ? script.parent_path() : fs::path(".");
  // -d: nobody's ~/.gnuplot changes the figure.
  const ProcessResult outcome = run_process({gnuplot, "-d", "./" + script.filename().string()}, folder);
  if (outcome.is_missing())
    return failure(
        "gnuplot_missing", script.string(),
        "gnuplot is not installed: apt-get install gnuplot-nox (the script is written; run it with gnuplot "
        "to draw the figure)");
  if (outcome.spawn_error != 0)
    return failure("gnuplot_failed", script.string(), "gnuplot cannot be started: " + outcome.complaint());
  if (!outcome.succeeded())
    return failure("gnuplot_failed", script.string(), "gnuplot could not draw it: " + outcome.complaint());
  return {};
}

/// Cairo writes the time into a PDF; overwritten in place, so that nothing moves and the same figure is the
/// same file.
Expected<void> remove_date(const fs::path& pdf) {
  std::ifstream file(pdf, std::ios::binary);
  std::string bytes(std::istreambuf_iterator<char>(file), {});
  constexpr std::string_view mark = "/CreationDate (D:", epoch = "19700101000000";
  const std::size_t place = bytes.find(mark);
  if (place == std::string::npos || place + mark.size() + epoch.size() > bytes.size()) return {};
  bytes.replace(place + mark.size(), epoch.size(), epoch);
  return write_text(bytes, pdf);
}

}  // namespace

Expected<std::vector<fs::path>> write_figure(const Figure& figure, const fs::path& stem,
                                             const FigureOptions& options) {
  const auto file = [&](std::string_view ending) { return fs::path(stem) += fmt::format(".{}", ending); };
  std::vector<fs::path> files{file("gp")};
  const std::string name = stem.filename().string();
  if (auto written = write_text(gnuplot_script(figure, name, options), files.front()); !written)
    return tl::unexpected(std::move(written.error()));
  if (auto drawn = draw(files.front(), options.gnuplot); !drawn)
    return tl::unexpected(std::move(drawn.error()));
  for (const FigureFormat format : options.formats) {
    files.push_back(file(extension(format)));
    if (format != FigureFormat::pdf) continue;
    if (auto done = remove_date(files.back()); !done) return tl::unexpected(std::move(done.error()));
  }
  return files;
}

}  // namespace sinew::inline v0
