/// @file questions.hpp
/// The handler of all questions, whatever is asked and whatever answers.
#pragma once
#include "query/loads.hpp"

namespace sinew::inline v1 {

/// A question is read, solved once, and told. `Asked` is what one kind of mechanics is asked; made of a
/// Context, it is a Question, too, and has
///   read()      takes all fields and computes nothing: what places the robot, what acts on it, where a
///   search begins,
///               what is wanted;
///   solve()     finds what the question asks for; where this is left out it is found as it is told;
///   tell()      writes how that went, and what is wanted of it;
///   wants_all   of some: whether other solutions are wanted, too, which
///   tell_all()  then finds and writes.
template <class Asked>
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

/// `until` and `all`, of which a question has one: a load that grows is followed, or many solutions are
/// found.
template <class Asked>
void read_until_or_all(Asked& asked) {
  asked.until = asked.read_until();
  const auto all = asked.query.optional("all");
  asked.wants_all = all && all->boolean();
  if (asked.until && asked.wants_all)
    all->fail("ambiguous", "until follows one equilibrium, all finds many; keep one");
}

}  // namespace sinew::inline v1
