/// @file questions.hpp
/// The handler of all questions, whatever is asked and whatever answers.
#pragma once
#include <concepts>

#include "query/context.hpp"

namespace sinew::inline v1 {

/// What one kind of mechanics is asked. Beside what is named here some have
/// * `solve()`, which finds it; where there is none it is found as it is told;
/// * `wants_all`, whether other solutions are wanted, too, and `tell_all()`, which finds and writes them.
template <class Asked>
concept AskedQuestion = std::derived_from<Asked, Question> && std::constructible_from<Asked, Context&> &&
    requires(Asked asked) {
  asked.read();  // takes all fields, and computes nothing
  asked.tell();  // writes how it went, and what is wanted of it
};

/// A question is read, solved once, and told.
template <AskedQuestion Asked>
void answer_question(Context& context) {
  Asked asked(context);
  asked.read();
  if (!asked.ready()) return;
  if constexpr (requires { asked.solve(); }) asked.solve();
  if (!asked.errors.empty()) return;  // such as fields that contradict each other
  asked.tell();
  if constexpr (requires { asked.tell_all(); })
    if (asked.wants_all) asked.tell_all();
}

}  // namespace sinew::inline v1
