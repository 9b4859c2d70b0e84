#include "query/loads.hpp"

#include "solve/stopped.hpp"

namespace sinew::inline v1 {

Wanted read_want(Context& context) {
  Wanted wanted;
  const auto list = context.query.optional("want");
  if (!list) return wanted;
  for (const Reader& word : list->items()) {
    const std::string name = word.choice({"stiffness", "stability", "margins", "sensitivity", "lines"});
    if (name == "lines") word.refuse("not_available", "legs that bear load have no lines; ask for stiffness");
    wanted.stiffness = wanted.stiffness || name == "stiffness";
    wanted.stability = wanted.stability || name == "stability";
    wanted.margins = wanted.margins || name == "margins";
    wanted.sensitivity = wanted.sensitivity || name == "sensitivity";
  }
  if (const auto of = context.query.optional("with_respect_to"))
    of->fail("not_available", "sensitivity is by the inputs in this version; leave this out");
  return wanted;
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
