/// @file compare.hpp
/// Ours beside the paper's: the rows of a reproduction and the files it leaves.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/io/figure.hpp"
#include "sinew/study/reproduce.hpp"

namespace sinew::inline v0::compare {

/// The first lines of a result's file: version, study, what it has, and of which robot.
std::vector<std::string> provenance(std::string_view id, std::string_view what, std::string_view robot);

std::string number(double value);  ///< six digits
std::string small(double value);   ///< a difference: two digits

/// A number that the paper prints: `agrees` to rounding.
Finding printed(std::string quantity, double paper, double ours, const char* unit);

/// Something that the paper gives in words or by a formula: `agrees` where ours is at most `bound` off.
Finding given(std::string quantity, std::string paper, std::string ours, double off, double bound,
              const char* unit);

/// A claim: `holds` where `off`, how far ours is from it, is at most `bound`. NaN fails.
Finding claimed(std::string quantity, std::string paper, std::string ours, double off, double bound,
                const char* unit);

/// The findings as a file, so that they are there where the figures cannot be drawn.
Expected<void> write_findings(Reproduction& result, const std::filesystem::path& path);

/// One figure that cannot be drawn does not keep the others from being written.
void add_figure(Reproduction& result, Errors& errors, const Figure& figure,
                const std::filesystem::path& stem);

}  // namespace sinew::inline v0::compare
