/// @file field_units.hpp
/// The units of the numbers of a robot's questions and answers.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "query/batch/field_layout.hpp"
#include "sinew/batch.hpp"
#include "sinew/io/node.hpp"

namespace sinew::inline v1 {

class FieldUnits {
 public:
  /// @param robot by the model that is asked for
  FieldUnits(const Robot& robot, const Node& query);

  /// What stands at a place of the question. Its unit names those of its numbers in the order in which they
  /// first stand, `N/m, N, N m`; 1 is that of plain numbers among others.
  Batch::Field input(std::string name, const std::string& place, const FieldLayout& layout) const;
  /// The same of its answers.
  Batch::Field output(std::string name, const std::string& place, const FieldLayout& layout) const;

 private:
  enum class Holding { tensions, changes, both };  ///< what tendons of arms are held by

  std::string of_question(std::string_view place) const;
  std::string of_answer(std::string_view place) const;
  std::string joined(const std::string& place, const FieldLayout& layout,
                     std::string (FieldUnits::*of)(std::string_view) const) const;
  std::string of_block(std::string_view name, std::size_t row, std::size_t column) const;
  std::string of_input(std::size_t input) const;
  std::string of_coordinate(std::size_t column) const;
  std::string of_constraint(std::size_t row) const;
  std::string_view motion(std::size_t freedom) const { return freedom < linear_ ? "m" : "rad"; }
  std::string_view load(std::size_t freedom) const { return freedom < linear_ ? "N" : "N m"; }

  enum class Kind { arcs, chains, rods, serial, arms };

  AnswerPlaces places_;
  Kind kind_;
  std::size_t linear_, legs_;        ///< freedoms along axes; legs, whose constraints are J's first rows
  std::vector<std::string> inputs_;  ///< what answers call so, or of serial robots their coordinates
  Holding holding_;
};

}  // namespace sinew::inline v1
