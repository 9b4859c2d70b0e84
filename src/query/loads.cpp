#include "query/loads.hpp"

#include "io/reader.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v1 {

Wants read_wants_of_loads(Context& context, Wants usual) {
  const Wants wants = read_wants(context, usual, equilibrium_wants);
  if (const auto of = context.query.optional("with_respect_to"))
    of->fail("not_available", "sensitivity is by the inputs in this version; leave this out");
  return wants;
}

std::vector<double> read_forces(const Reader& given, std::size_t count, const Range& range,
                                bool one_for_all) {
  if (one_for_all && !given.is(Node::Kind::list))
    return std::vector<double>(count, given.quantity(Dimension::force, range));
  std::vector<double> forces;
  for (const Reader& item : given.items(count)) forces.push_back(item.quantity(Dimension::force, range));
  return forces;
}

bool read_all(Context& context) {
  const auto all = context.query.optional("all");
  return all && all->boolean();
}

void put_solutions(Context& context, Value solutions) {
  if (Report stopped; note_stop(context.work.stop, stopped)) context.report(stopped);
  context.answer["count"] = solutions.size();
  context.answer["complete"] = false;
  context.answer["solutions"] = std::move(solutions);
}

}  // namespace sinew::inline v1
