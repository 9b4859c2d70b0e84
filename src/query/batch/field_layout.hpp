/// @file field_layout.hpp
/// How many numbers stand at a place of a question or of an answer, and how their lists are nested:
/// `pose.position` has three, `tensions` two for each leg.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

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

/// What is a list of numbers among the fields of a robot's questions and answers. All else is taken for one
/// number: what `set` changes, and the fields of diagrams.
class FieldLayouts {
 public:
  /// @param query the kind of question, `forward`
  FieldLayouts(const Robot& robot, std::string_view query);

  FieldLayout input(std::string_view place) const;
  FieldLayout output(std::string_view place) const { return find(outputs_, place); }

 private:
  struct Entry {
    std::string_view key;  ///< the last word of the place
    FieldLayout layout;
  };
  using Table = std::vector<Entry>;

  void read_platform(const Robot& robot, std::string_view query);
  void read_sections(const SerialRobot& robot);
  static FieldLayout find(const Table& table, std::string_view place);

  Table inputs_, outputs_;
};

}  // namespace sinew::inline v1
