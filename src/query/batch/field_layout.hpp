/// @file field_layout.hpp
/// How many numbers stand at a place of a question or of an answer, and how their lists are nested:
/// `pose.position` has three, `tensions` two for each leg.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "query/fields/answer_places.hpp"
#include "sinew/robot/robot.hpp"

namespace sinew::inline v1 {

/// Numbers are counted in the order in which they stand.
struct FieldLayout {
  std::vector<std::size_t> shape;  ///< as an array has it; empty of a single number
  /// How many numbers each list within the list has; empty where the numbers stand in it directly. Lists of
  /// several lengths, such as the changes of sections with more and fewer tendons, are one row of numbers.
  std::vector<std::size_t> lists;

  std::size_t size() const;
  /// Where a number stands after the place of the field: `[1][0]`; nothing of a single number.
  std::string suffix(std::size_t number) const;
};

/// How the fields of a robot's questions and answers lie, by the tables of fields. All else is taken for one
/// number: what `set` changes, and the fields of diagrams.
class FieldLayouts {
 public:
  /// @param query the kind of question, `forward`
  FieldLayouts(const Robot& robot, std::string_view query);

  FieldLayout input(std::string_view place) const;
  FieldLayout output(std::string_view place) const;
  /// Why a place of an answer is no column: an index too large, or a list whose length the robot alone does
  /// not tell. Empty where it is one.
  std::string why_no_column(std::string_view place) const;

 private:
  using Lengths = std::vector<std::size_t>;

  void count(const Robot& robot);
  void count(const SerialRobot& robot);
  void count(const Arm& arm);
  void count(const ArmLegs& robot);
  FieldLayout lists(std::string_view name) const;
  FieldLayout whole(AnswerShape shape) const;

  AnswerPlaces places_;
  bool is_diagram_, is_statics_, is_serial_ = false, is_arm_ = false, is_planar_ = false;
  std::size_t inputs_ = 0, freedoms_ = 0, legs_ = 0, rows_ = 0, columns_ = 0;  ///< rows of J, columns of K
  Lengths angles_;                                                             ///< of chains, a leg each
  Lengths configuration_, tendons_;  ///< of serial robots and arms, a section each
};

}  // namespace sinew::inline v1
