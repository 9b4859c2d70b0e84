/// Tendons of the legs: which are taut, and their tensions, changes of length and slack.
#include "kinematics/arm_legs/group/arm_group.hpp"

#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "base/at.hpp"
#include "kinematics/arms/tensions/bounded_least_squares.hpp"
#include "kinematics/arms/tensions/tension_search.hpp"
#include "solve/contraction.hpp"

namespace sinew::inline v1 {
namespace {

/// A tendon is redundant where less than this share of its length's gradient [1] is not in those of others:
/// the square of it is what the equations have of it, of which rounding leaves 1e-16.
constexpr double least_of_its_own = 1e-5;
/// A tendon is as long as its way where it is off by less than this share of the leg's length [1]: as much as
/// an equilibrium may leave.
constexpr double rounding_of_ways = 1e-9;
/// A tension that is less than this share of the usual one [1] is none but rounding.
constexpr double least_pull = 1e-8;

}  // namespace

/// Of the length's error of a tendon by its tension: what an arm yields to it, roughly [m/N].
double ArmGroup::yields(const Arm& arm, const ArmTendon& tendon) {
  double sum = 0;
  for (std::size_t m = 0; m < tendon.routes.size(); ++m) {
    const ArmSection& section = arm.sections[m];
    const double r = tendon.routes[m].start_radius;
    sum += r * r * section.length / std::min(section.start.bending_x, section.start.bending_y);
  }
  return sum;
}

std::pair<const ArmGroup::Leg*, const ArmGroup::Tendon*> ArmGroup::find(int feed) const {
  const auto after = std::ranges::find_if(legs_, [&](const Leg& leg) { return leg.first_feed > feed; });
  const Leg& leg = *std::prev(after);
  return {&leg, &leg.tendons[at(feed - leg.first_feed)]};
}
double ArmGroup::held(int feed) const { return find(feed).second->command.value; }
void ArmGroup::set_feed(int feed, double value) {
  const_cast<Tendon*>(find(feed).second)->command.value = value;  // of this group, which is not const here
  set_share(share_);
}

/// Of a tendon whose length is prescribed, after the rod's sweep [m].
double ArmGroup::missing_length(const Leg& leg, std::size_t index) const {
  const Tendon& tendon = leg.tendons[index];
  return rod(leg).work().lengths[index] - tendon.free_length - tendon.compliance * tendon.tension -
         softness(tendon) * (tendon.tension - tendon.expected);
}

/// Which tendons are taut, the numbers of their unknowns, and what they pull with at holes and guides, after
/// the rod's sweep. A tendon of prescribed length pulls where it is shorter than its way, or would be without
/// its tension.
/// @returns the largest error of a taut one's length, over the leg's
double ArmGroup::measure_tendons(Leg& leg) {
  const strain::RodModel& model = rod(leg).model();
  strain::RodWork& work = rod(leg).work();
  leg.taut = 0;
  int loose = 0;
  double error = 0;
  const double size = leg.own->arm.length();
  for (std::size_t i = 0; i < leg.tendons.size(); ++i) {
    Tendon& tendon = leg.tendons[i];
    tendon.is_taut = tendon.is_redundant = false;
    tendon.relief = 0;
    if (tendon.command.held == TendonHeld::tension) {
      tendon.tension = tendon.target;
      tendon.place = loose++;
      continue;
    }
    const double missing = missing_length(leg, i);
    tendon.is_taut = tendon.tension + missing / tendon.unit > 0;
    tendon.place = tendon.is_taut ? leg.taut++ : -1;
    if (tendon.is_taut)
      error = worse(error, std::abs(missing) / size);
    else
      tendon.tension = 0;
  }
  const auto tension = [&](int index) { return leg.tendons[at(index)].tension; };
  for (std::size_t i = 0; i < model.holes.size(); ++i) work.hole_tension[i] = tension(model.holes[i].tendon);
  for (std::size_t i = 0; i < model.guides.size(); ++i)
    work.guide_tension[i] = tension(model.guides[i].tendon);
  return error;
}

/// Of taut tendons whose lengths change alike, those that are needed: others have tensions that no equation
/// determines, since a backbone that does not stretch bears what they pull with together without bending.
/// Those that pull most, or are most too short, come first; tendons that are as long as their way and do not
/// pull come last, since they might. After `measure_tendons` and the gradients of lengths.
void ArmGroup::leave_out_redundant_tendons(Leg& leg) const {
  const strain::RodWork& work = rod(leg).work();
  const auto n = static_cast<Eigen::Index>(rod(leg).model().size);
  std::vector<std::size_t> tight;
  for (std::size_t i = 0; i < leg.tendons.size(); ++i) {
    const Tendon& tendon = leg.tendons[i];
    if (tendon.is_taut || tendon.is_redundant ||
        (tendon.command.held == TendonHeld::change &&
         std::abs(missing_length(leg, i)) < rounding_of_ways * leg.own->arm.length()))
      tight.push_back(i);
  }
  leg.undetermined.resize(static_cast<Eigen::Index>(leg.tendons.size()), 0);
  if (leg.taut == 0 || tight.size() < 2) return;
  const auto urge = [&](std::size_t i) {
    return leg.tendons[i].tension + missing_length(leg, i) / leg.tendons[i].unit;
  };
  std::ranges::stable_sort(tight, [&](std::size_t a, std::size_t b) { return urge(a) > urge(b); });
  std::vector<Vector> directions;  // each as a unit, less what those before it have; compliances follow
  bool is_redundant = false;
  for (const std::size_t i : tight) {
    Tendon& tendon = leg.tendons[i];
    Vector own = Vector::Zero(n + static_cast<Eigen::Index>(leg.tendons.size()));
    own.head(n) = Eigen::Map<const Vector>(work.length_gradient.data() + i * at(static_cast<int>(n)), n);
    own[n + static_cast<Eigen::Index>(i)] = std::sqrt(tendon.compliance + softness(tendon));
    const double all = own.norm();
    for (const Vector& other : directions) own -= other.dot(own) * other;
    for (const Vector& other : directions) own -= other.dot(own) * other;  // what rounding left
    const double left = own.norm();
    if (left > least_of_its_own * all) {
      directions.emplace_back(own / left);
      continue;
    }
    is_redundant = true;
    tendon.is_redundant = tendon.is_redundant || tendon.is_taut;
    tendon.is_taut = false;
    tendon.place = -1;
  }
  if (!is_redundant) return;
  leg.taut = 0;
  for (Tendon& tendon : leg.tendons)
    if (tendon.is_taut) tendon.place = leg.taut++;
  relieve(leg, tight);
}

/// @param gradients of the tight tendons' lengths, a row for each strain
void ArmGroup::set_undetermined(Leg& leg, const std::vector<std::size_t>& tight,
                                const std::vector<double>& gradients) {
  const auto count = static_cast<Eigen::Index>(tight.size());
  const Eigen::Map<const Matrix> rows(gradients.data(), rod(leg).model().size, count);
  const Eigen::JacobiSVD<Eigen::MatrixXd> parts(rows, Eigen::ComputeFullV);
  const auto& sizes = parts.singularValues();
  Eigen::Index rank = 0;
  while (rank < sizes.size() && sizes[rank] > least_of_its_own * sizes[0]) ++rank;
  leg.undetermined = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(leg.tendons.size()), count - rank);
  for (Eigen::Index k = 0; k < count; ++k)
    leg.undetermined.row(static_cast<Eigen::Index>(tight[static_cast<std::size_t>(k)])) =
        parts.matrixV().row(k).tail(count - rank);
}

/// Of all tensions that act on the leg's shape alike the next step goes to those with the least sum of
/// squares: where tendons are redundant nothing else determines them.
/// @param tight those that may pull
void ArmGroup::relieve(Leg& leg, const std::vector<std::size_t>& tight) {
  strain::RodWork& work = rod(leg).work();
  const int n = rod(leg).model().size;
  std::vector<double> gradients, force(at(n), 0.0);
  for (int j = 0; j < n; ++j)
    for (const std::size_t i : tight) {
      gradients.push_back(work.length_gradient[i * at(n) + at(j)]);
      force[at(j)] += gradients.back() * leg.tendons[i].tension;
    }
  const std::vector<double> least = bounded_least_squares(
      gradients, force, std::vector<double>(tight.size(), 0.0), std::numeric_limits<double>::infinity());
  set_undetermined(leg, tight, gradients);
  for (std::size_t k = 0; k < tight.size(); ++k) {
    Tendon& tendon = leg.tendons[tight[k]];
    tendon.relief = least[k] - tendon.tension;
    for (int j = 0; j < n; ++j) work.gradient[at(j)] += tendon.relief * gradients[at(j) * tight.size() + k];
  }
}

void ArmGroup::soften(double share) {
  softness_ = share;
  for (Leg& leg : legs_)
    for (Tendon& tendon : leg.tendons) tendon.expected = tendon.tension;
}

auto ArmGroup::softened_error() const -> LengthError {
  LengthError worst;
  for (const Leg& leg : legs_)
    for (std::size_t i = 0; i < leg.tendons.size(); ++i) {
      const Tendon& tendon = leg.tendons[i];
      if (tendon.command.held != TendonHeld::change) continue;
      const double error = softness(tendon) * (tendon.tension - tendon.expected);
      if (std::abs(error) > std::abs(worst.error))
        worst = {error, leg.own->arm.length(), leg.first_feed + static_cast<int>(i)};
    }
  return worst;
}

bool ArmGroup::has_redundant_tendons() const {
  return std::ranges::any_of(legs_, [](const Leg& leg) {
    return std::ranges::any_of(leg.tendons, [&](const Tendon& tendon) {
      return tendon.is_redundant && tendon.tension > least_pull * usual_tension(leg.own->arm);
    });
  });
}

Eigen::MatrixXd ArmGroup::undetermined_tensions() const {
  Eigen::Index count = 0;
  for (const Leg& leg : legs_) count += leg.undetermined.cols();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(feeds_, count);
  for (Eigen::Index next = 0; const Leg& leg : legs_) {
    all.block(leg.first_feed, next, leg.undetermined.rows(), leg.undetermined.cols()) = leg.undetermined;
    next += leg.undetermined.cols();
  }
  return all;
}

double ArmGroup::relief() const {
  double most = 0;
  for (const Leg& leg : legs_)
    for (const Tendon& tendon : leg.tendons)
      most = worse(most, std::abs(tendon.relief) / usual_tension(leg.own->arm));
  return most;
}

double ArmGroup::tension(int feed) const { return find(feed).second->tension; }
double ArmGroup::effort(int feed) const { return tension(feed); }
double ArmGroup::change(int feed) const {
  const auto [leg, tendon] = find(feed);
  if (tendon->command.held == TendonHeld::change) return tendon->command.value;
  const double way = rod(*leg).work().lengths[at(feed - leg->first_feed)];
  return way - tendon->rest - tendon->compliance * (tendon->tension - tendon->pretension);
}
double ArmGroup::slack(int feed) const {
  const auto [leg, tendon] = find(feed);
  if (tendon->command.held == TendonHeld::tension || tendon->is_taut) return 0;
  return std::max(0.0, tendon->free_length - rod(*leg).work().lengths[at(feed - leg->first_feed)]);
}

}  // namespace sinew::inline v1
