/// @file batch_question.hpp
/// One question put at many rows.
#pragma once
#include <string>
#include <vector>

#include "sinew/io/node.hpp"
#include "sinew/robot/robot.hpp"

namespace sinew::inline v1 {

/// `$name` stands in the query where the numbers of a column go.
struct BatchQuestion {
  Document robot;  ///< of a robot file
  Document query;
  std::vector<std::string> inputs;   ///< names of the columns that go in
  std::vector<std::string> outputs;  ///< places in the answers, see AnswerPath
  bool is_path = true;               ///< each row begins where the one before ended
  /// Of an input the texts that its numbers stand for; empty where they stand for themselves, or not there.
  std::vector<std::vector<std::string>> words = {};
};

/// The robot as a question has it: changed by the constants of its `set`, by its `model`. What does not go is
/// told by its answers.
Robot as_asked(const Document& document, const Robot& robot, const Node& query);

}  // namespace sinew::inline v1
