#include "figure_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "sinew/io/node.hpp"
#include "terminal.hpp"

namespace sinew::cli {
namespace {

constexpr std::array formats{FigureFormat::svg, FigureFormat::png, FigureFormat::pdf};

/// The format an extension names.
const FigureFormat* format_of(const std::filesystem::path& file) {
  const auto found = std::ranges::find_if(formats, [&](FigureFormat format) {
    return file.extension() == fmt::format(".{}", extension(format));
  });
  return found == formats.end() ? nullptr : &*found;
}

}  // namespace

Errors refuse_format(const std::string& file) {
  if (format_of(file)) return {};
  return {{"no_figure_format", "--output",
           fmt::format("{} the figure's file ends in .svg, .png or .pdf: -o fig.svg.",
                       in_quotes(file) + " names no format;")}};
}

int write_figure_file(const Arguments& arguments, const Figure& figure, const std::string& file) {
  if (const Errors errors = refuse_format(file); !errors.empty()) return refuse(arguments.verb, errors);
  const auto written =
      write_figure(figure, std::filesystem::path(file).replace_extension(), {.formats = {*format_of(file)}});
  if (!written) return refuse(arguments.verb, written.error());
  if (!arguments.has("quiet"))
    for (const auto& path : *written) print(path.string() + '\n');
  return solved;
}

}  // namespace sinew::cli
