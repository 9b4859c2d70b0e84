/// @file loads.hpp
/// What questions about loads may say, whatever bears them, and what is answered of many equilibria.
#pragma once
#include "io/document/reader.hpp"
#include "leg/space.hpp"
#include "query/wants.hpp"

namespace sinew::inline v1 {

/// What an equilibrium can tell.
constexpr Wants equilibrium_wants = usual_wants | Wants{Want::velocity,  Want::shape,   Want::stiffness,
                                                        Want::stability, Want::margins, Want::sensitivity};
Wants read_wants_of_loads(Question& question);
/// Says that sensitivity is by the inputs.
void refuse_other_sensitivity(Question& question);

/// Forces, then moments.
template <class Space>
Vec<double, Space::dof> read_wrench(const Reader& list) {
  constexpr std::size_t dof = Space::dof;
  Vec<double, Space::dof> wrench = Vec<double, Space::dof>::Zero();
  const auto items = list.items(dof);
  for (std::size_t k = 0; k < std::min(items.size(), dof); ++k)
    wrench[static_cast<Eigen::Index>(k)] =
        items[k].quantity(k < Space::dimension ? Dimension::force : Dimension::moment);
  return wrench;
}

/// A load that grows.
template <class Space>
struct Until {
  Vec<double, Space::dof> direction;
  double limit = 0;
};
template <class Space>
std::optional<Until<Space>> read_until(Question& context) {
  auto asked = context.query.optional("until");
  if (!asked) return {};
  const Reader wrench = asked->required("wrench", "the load that is added");
  Until<Space> until{read_wrench<Space>(wrench)};
  if (context.errors.empty() && until.direction.isZero(0))
    wrench.fail("out_of_range", "is the load that is added; not all of its numbers may be zero");
  until.limit =
      asked->required("limit", "how many times the wrench is added at most").number(Range::positive());
  asked->close();
  return until;
}

/// How far a load grew, and why no further.
template <class Path>
void put_growth(Value& answer, const Path& path) {
  answer["load"] = path.load;
  answer["why"] = to_string(path.end);
  if constexpr (requires { path.definite_until; })
    if (path.definite_until >= 0) answer["definite_until"] = path.definite_until;
}

/// One number for all, or one each.
std::vector<double> read_forces(const Reader& given, std::size_t count, const Range& range, bool one_for_all);

/// `all`: many solutions are wanted.
/// @param has_until a load that grows is followed in place of that: a question has one of the two
bool read_all(Question& question, bool has_until = false);
/// `solutions` that were found by many starts, without proof.
void put_solutions(Question& question, StopToken stop, Value solutions);

}  // namespace sinew::inline v1
