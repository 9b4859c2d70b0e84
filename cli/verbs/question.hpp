/// @file question.hpp
/// What verbs that put one question share.
#pragma once
#include "show.hpp"
#include "verbs.hpp"

namespace sinew::cli {

/// Errors on stderr, with --json on stdout too. The answer is the exit code.
int refuse_question(const Arguments& arguments, const Errors& errors);

/// The answer to the query that the options of this verb stand for; it may be an error, too.
Expected<Answer> put(std::string_view query, const Arguments& arguments, OpenRobot& robot);

/// Prints what people read, or with --json the answer as it is; on stderr its error, or why there is no
/// solution, or what the solution leaves out. The answer is the exit code.
int conclude(const Answer& answer, const Arguments& arguments, const std::string& shown);

}  // namespace sinew::cli
