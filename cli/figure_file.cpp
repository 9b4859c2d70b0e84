#include "figure_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "io/document/quantity.hpp"
#include "io/document/visible.hpp"
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

Expected<FigureOptions> page_options(const Arguments& arguments) {
  FigureOptions options;
  Errors errors;
  if (const std::string* text = arguments.text("width")) {
    constexpr double least = 0.04, most = 2;  // [m]
    const auto width = parse_quantity(*text, Dimension::length);
    if (!width)
      errors.push_back({width.error().front().code, "--width", width.error().front().message});
    else if (!(*width >= least && *width <= most))
      errors.push_back({"out_of_range", "--width",
                        fmt::format("a figure is 40 mm to 2 m wide; {} is {:.6g} mm. One column of a journal "
                                    "is 85 mm, two are 180 mm.",
                                    in_quotes(*text), 1e3 * *width)});
    else
      options.width = 1e3 * *width;
  }
  if (const std::string* text = arguments.text("font")) {
    const std::size_t comma = text->find(',');
    const std::string name = text->substr(0, comma);
    const bool is_name = std::ranges::all_of(name, [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) ||
             std::string_view(" -_.").find(c) != std::string_view::npos;
    });
    if (!is_name)
      errors.push_back(
          {"not_a_font", "--font",
           fmt::format("{} is no name of a font, which has letters, digits, spaces and -_. only: "
                       "--font \"Times New Roman,9\".",
                       in_quotes(*text))});
    else if (!name.empty())
      options.font = name;
    if (comma != std::string::npos) {
      std::string size = text->substr(comma + 1);
      if (size.ends_with("pt")) size.resize(size.size() - 2);
      while (size.starts_with(' ')) size.erase(0, 1);
      while (size.ends_with(' ')) size.pop_back();
      const auto points = parse_number(size);
      if (points && *points >= 4 && *points <= 72)
        options.font_size = *points;
      else
        errors.push_back({"out_of_range", "--font",
                          fmt::format("{}: after the comma stands a size of 4 to 72 points: --font "
                                      "\"Times New Roman,9\".",
                                      in_quotes(*text))});
    }
  }
  if (!errors.empty()) return tl::unexpected(std::move(errors));
  return options;
}

Errors refuse_figure(const Arguments& arguments, const std::string& file) {
  if (Errors errors = refuse_format(file); !errors.empty()) return errors;
  const auto options = page_options(arguments);
  return options ? Errors{} : options.error();
}

int write_figure_file(const Arguments& arguments, const Figure& figure, const std::string& file) {
  if (const Errors errors = refuse_format(file); !errors.empty()) return refuse(arguments.verb, errors);
  auto options = page_options(arguments);
  if (!options) return refuse(arguments.verb, options.error());
  options->formats = {*format_of(file)};
  options->replaces_edited_script = arguments.has("force");
  const auto written = write_figure(figure, std::filesystem::path(file).replace_extension(), *options);
  if (!written) return refuse(arguments.verb, written.error());
  if (!arguments.has("quiet"))
    for (const auto& path : *written) print(visible_line(path.string()) + '\n');
  return solved;
}

}  // namespace sinew::cli
