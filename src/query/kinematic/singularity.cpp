/// The field `along` of velocity queries: the nearest type II in a direction.
#include <algorithm>

#include "query/context.hpp"
#include "sinew/analysis/singularity.hpp"

namespace sinew::inline v1 {

std::optional<Along> read_along(Context& context) {
  const auto direction = context.query.optional("along");
  const auto limit = context.query.optional("limit");
  if (!direction) {
    if (limit) limit->fail("no_effect", "ends the search along a direction; give along, or remove it");
    return {};
  }
  Along along{direction->quantities(Dimension::number, {}, static_cast<std::size_t>(dof(context.robot)))};
  if (context.errors.empty() && std::ranges::all_of(along.direction, [](double part) { return part == 0; }))
    direction->fail("out_of_range", "is a direction; not all of its numbers may be zero");
  if (limit) along.limit = limit->number(Range::positive());
  return along;
}

void put_type_2_distance(Context& context, const Along& along, const Configuration& given,
                         const AnyPose& pose) {
  InverseOptions branch = given.branch.options();
  if (given.inputs) branch.start = *given.inputs;
  const TypeTwoDistance found = type_2_distance(context.robot, pose, along.direction,
                                                {.branch = branch, .limit = along.limit}, context.work);
  if (found.report.status == Status::stopped)
    context.report(found.report);  // before: it may move all members
  Value& answer = context.answer["type_2_distance"];
  answer["found"] = found.found;
  if (found.found) {
    answer["distance"] = found.distance;
    answer["pose"] = pose_value(found.pose);
    answer["class"] = to_string(found.type_2.kind);
    return;
  }
  answer["why"] = found.report.ok() ? "there is none up to the limit" : found.report.message.view();
  answer["reached"] = found.distance;
  answer["pose"] = pose_value(found.pose);
}

}  // namespace sinew::inline v1
