/// @file choose_outputs.hpp
/// What comes out of every row of a question.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "query/batch/batch_question.hpp"
#include "query/batch/field_layout.hpp"
#include "sinew/base/error.hpp"

namespace sinew::inline v1 {

using BatchOutputs = std::vector<std::pair<std::string, std::string>>;  ///< names, places in the answer

/// What people ask a question for, and how well it is solved, where that is not in closed form.
BatchOutputs usual_outputs(const Robot& robot, std::string_view query);

/// Where none are named: the usual ones, and what the words of `want` give beside them. Gives the question
/// those words that its outputs go with. Errors: places where no answer has a number, `all` without outputs
/// that tell of the solutions.
/// @param robot by the model that is asked for
Errors choose_outputs(const Robot& robot, const FieldLayouts& layouts, BatchOutputs& outputs,
                      BatchQuestion& question);

}  // namespace sinew::inline v1
