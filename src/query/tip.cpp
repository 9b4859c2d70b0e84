#include "query/tip.hpp"

#include <fmt/format.h>

#include <cmath>

#include "io/document/reader.hpp"
#include "io/robots/read_pose.hpp"

namespace sinew::inline v1 {

AskedTip read_tip(Question& question, bool is_direction_enough) {
  AskedTip asked;
  Reader& query = question.query;
  const auto position = query.optional("position"), direction = query.optional("direction");
  if (auto pose = query.optional("pose")) {
    for (const auto& [key, other] : {std::pair{"position", &position}, {"direction", &direction}})
      if (*other) (*other)->fail("ambiguous", fmt::format("the query gives a pose and a {}; keep one", key));
    asked.pose = read_spatial_pose(std::move(*pose));
    return asked;
  }
  if (position)
    asked.position = position->array<3>(Dimension::length, Range::place());
  else if (!is_direction_enough)
    query.required("position", "of the tip; or a pose");
  else if (!direction)
    query.required("position", "of the tip; or a direction, or a pose");
  if (!direction) return asked;
  const auto axis = direction->array<3>(Dimension::number, Range::place());
  if (std::hypot(axis[0], axis[1], axis[2]) < 1e-9)
    direction->fail("no_direction", "a direction needs a length of at least 1e-9");
  asked.direction = axis;
  return asked;
}

}  // namespace sinew::inline v1
