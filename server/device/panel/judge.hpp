/// @file judge.hpp
/// What state each section is in, by the section diagram of what its drives measure.
#pragma once
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "arm.hpp"
#include "sinew/session.hpp"

namespace sinew::server::device {

/// In the order of severity.
enum class Word { exact, slack, unreachable, no_data, over_tensioned };
/// As it is shown: `PARTLY SLACK`.
std::string_view name_of(Word word, bool is_partial = false);
/// As the log has it: `over`.
std::string_view kind_of(Word word);

struct SectionState {
  Word word = Word::no_data;
  bool is_partial = false, is_near_limit = false;
  double amount = 0;               ///< how slack or over-tensioned [m]; of unreachable the bend [rad]
  std::string advice;              ///< what helps; empty: nothing is wrong
  nlohmann::ordered_json diagram;  ///< the answer to `diagram`, null: none
};

/// What drives measure that can.
struct Tensions {
  std::span<const double> of_tendons;  ///< [N]; empty: not measured
  double limit = 0;                    ///< [N], 0: none
};

/// Looks at one robot. Not for two threads.
class Judge {
 public:
  Judge(Session session, const Arm& arm);

  /// @param lengths measured changes of all tendons [m]
  /// @param is_homed else changes mean nothing, and tensions alone are looked at
  SectionState state(std::size_t section, kernel::Model model, std::span<const double> lengths,
                     const Tensions& tensions, bool is_homed);

 private:
  void look_at_changes(SectionState& state, std::size_t section, kernel::Model model,
                       std::span<const double> lengths);
  void look_at_tensions(SectionState& state, std::size_t section, const Tensions& tensions) const;
  Session session_;
  std::size_t tendons_;
};

}  // namespace sinew::server::device
