/// @file compare.hpp
/// Ours beside the paper's: the rows of a reproduction.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "study/reproduce.hpp"

namespace sinew::inline v1::compare {

/// The first lines of a result's file: version, study, what it has, and of which robot.
std::vector<std::string> provenance(std::string_view id, std::string_view what, std::string_view robot);

std::string number(double value);  ///< six digits
std::string small(double value);   ///< a difference: two digits

/// A number that the paper prints: `agrees` to rounding.
Finding printed(std::string quantity, double paper, double ours, const char* unit);

/// Something that the paper gives in words or by a formula: `agrees` where ours is at most `bound` off.
Finding given(std::string quantity, std::string paper, std::string ours, double off, double bound,
              const char* unit);

/// A reference beside ours, with the tolerance that is asked: `agrees` within it.
Finding within(std::string quantity, std::string reference, std::string ours, double off, double tolerance,
               const char* unit);

/// A claim: `holds` where `off`, how far ours is from it, is at most `bound`. NaN fails.
Finding claimed(std::string quantity, std::string paper, std::string ours, double off, double bound,
                const char* unit);

}  // namespace sinew::inline v1::compare
