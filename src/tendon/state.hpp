/// @file state.hpp
/// The state of a section in words, for whoever shows it: what it is called, by how much, what helps.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "sinew/tendon/diagram.hpp"

namespace sinew::inline v1 {

struct StateWords {
  std::string_view word;  ///< `EXACT`, `SLACK`, `PARTLY SLACK`, `OVER-TENSIONED`, `UNREACHABLE`
  double amount = 0;  ///< the most that a tendon has too much, or lacks [m]; unreachable: what is asked for
                      ///< in the unit of the envelope's limit; exact: 0
  bool is_near_limit = false;  ///< the point is within 5 % of the envelope's limit, or beyond it
  std::string advice;          ///< what helps, without a full stop; empty: nothing is wrong
};

/// @param diagram the answer to the question
StateWords state_words(const DiagramQuestion& question, const SectionDiagram& diagram);

std::string_view state_word(TendonConsistency agree, bool is_partial);
/// `tendons 1, 2 and 3`, from indices.
std::string tendon_names(std::span<const std::size_t> tendons);

}  // namespace sinew::inline v1
