/// @file figure_file.hpp
/// A figure into the file that a command line names.
#pragma once
#include <string>

#include "io/figure/figure.hpp"
#include "verbs.hpp"

namespace sinew::cli {

/// `no_figure_format` where the name ends in none; empty where it does.
Errors refuse_format(const std::string& file);

/// How large the page is and its font, as `--width` and `--font` say.
Expected<FigureOptions> page_options(const Arguments& arguments);

/// What is wrong with the file's name or the page, before anything is solved.
Errors refuse_figure(const Arguments& arguments, const std::string& file);

/// Draws it and says what was written; the answer is the exit code.
int write_figure_file(const Arguments& arguments, const Figure& figure, const std::string& file);

}  // namespace sinew::cli
