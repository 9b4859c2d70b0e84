#include "query/loads.hpp"

#include "io/document/reader.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v1 {

Wants read_wants_of_loads(Question& question) {
  const Wants wants = read_wants(question);
  refuse_other_sensitivity(question);
  return wants;
}

void refuse_other_sensitivity(Question& question) {
  if (const auto of = question.query.optional("with_respect_to"))
    of->fail("not_available", "sensitivity is by the inputs in this version; leave this out");
}

std::vector<double> read_forces(const Reader& given, std::size_t count, const Range& range,
                                bool one_for_all) {
  if (one_for_all && !given.is(Node::Kind::list))
    return std::vector<double>(count, given.quantity(Dimension::force, range));
  std::vector<double> forces;
  for (const Reader& item : given.items(count)) forces.push_back(item.quantity(Dimension::force, range));
  return forces;
}

bool read_all(Question& question, bool has_until) {
  const auto all = question.query.optional("all");
  if (!all || !all->boolean()) return false;
  if (has_until) all->fail("ambiguous", "until follows one equilibrium, all finds many; keep one");
  return true;
}

void put_solutions(Question& question, StopToken stop, Value solutions) {
  if (Report stopped; note_stop(stop, stopped)) question.report(stopped);
  question.answer["count"] = solutions.size();
  question.answer["complete"] = false;
  question.answer["solutions"] = std::move(solutions);
}

}  // namespace sinew::inline v1
