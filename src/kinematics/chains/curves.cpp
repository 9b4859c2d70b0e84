/// Curves of equilibria on chains.
#include "kinematics/chains/chain_curve.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics/chains/path.hpp"
#include "kinematics/load_problem.hpp"
#include "solve/curve_writer.hpp"

namespace sinew::inline v1 {
namespace {

TendonConstraint difference(const TendonConstraint& from, const TendonConstraint& to) {
  return {to.length_of,
          to.length - from.length,
          {to.tension[0] - from.tension[0], to.tension[1] - from.tension[1]}};
}

/// What legs hold changes with the load.
template <class Space>
class ChainProblem : public LoadProblem<Space> {
 public:
  using Base = LoadProblem<Space>;
  using Base::unknowns;
  using typename Base::Rows, typename Base::Twist;
  using Curve = ChainCurve<Space>;

  ChainProblem(const ChainLegs<Space>& robot, ChainGroup<Space>& group, const ChainCurveOptions<Space>& how)
      : Base(group, how.added_wrench),
        robot_(robot),
        chains_(group),
        from_(group.state().hold) {
    for (std::size_t i = 0; i < how.hold.size(); ++i) rates_.push_back(difference(from_[i], how.hold[i]));
    fed_.resize(rates_.size());
  }

  Rows equations(double scale) const {
    Rows rows = Base::equations(scale);
    typename Base::Wrench by_parameter = -this->load_;
    for (std::size_t i = 0; i < rates_.size(); ++i)
      by_parameter += chains_.hold_wrench_jacobian(i, rates_[i]);
    this->put_column(rows, unknowns, by_parameter, scale);
    return rows;
  }
  double longest_scale() const {
    double fed = 0;
    for (std::size_t i = 0; i < rates_.size(); ++i)
      fed = std::max(fed, chains_.hold_wrench_jacobian(i, rates_[i]).template head<Base::forces>().norm());
    return Base::longest_scale() + fed / this->unit_;
  }
  void move(const Twist& step, double lambda, double change) {
    for (std::size_t i = 0; i < rates_.size(); ++i)
      fed_[i] =
          change * (rates_[i].length_of >= 0 ? rates_[i].length : rates_[i].tension[chains_.system(i).fed]);
    chains_.move(this->comparable(step), fed_);
    put(lambda + change);
  }
  void put(double lambda) {
    Base::put(lambda);
    for (std::size_t i = 0; i < rates_.size(); ++i) {
      TendonConstraint hold = from_[i];
      hold.length += lambda * rates_[i].length;
      for (std::size_t k = 0; k < 2; ++k) hold.tension[k] += lambda * rates_[i].tension[k];
      chains_.hold_leg(i, hold);
    }
  }

  ChainCurvePoint<Space> point(double lambda, double residual, CurveMark mark, int unstable) const {
    ChainState<Space> state = chains_.state();
    for (std::size_t i = 0; i < state.legs.size(); ++i) measure_tendons(robot_.legs[i], state.legs[i]);
    const double energy = potential(robot_, state);
    return {lambda,   static_cast<CurveEvent>(mark), std::move(state),
            unstable, residual * this->size_,        energy};
  }
  bool is_same(const ChainCurvePoint<Space>& one, const ChainCurvePoint<Space>& other) const {
    double apart = twist_between(Space::frame(one.state.pose), Space::frame(other.state.pose)).norm();
    for (std::size_t i = 0; i < one.state.legs.size(); ++i)
      for (std::size_t j = 0; j < one.state.legs[i].angles.size(); ++j)
        apart = std::max(apart, std::abs(one.state.legs[i].angles[j] - other.state.legs[i].angles[j]));
    return apart < 1e-8;
  }
  bool is_far() const { return false; }  // chains are as long as they are
  CurveEnd end_of(CurveStop stop) const {
    constexpr CurveEnd ends[] = {CurveEnd::left_range,  CurveEnd::closed,  CurveEnd::max_points,
                                 CurveEnd::far,         CurveEnd::stopped, CurveEnd::stalled,
                                 CurveEnd::not_followed};
    return ends[static_cast<int>(stop)];
  }

 private:
  const ChainLegs<Space>& robot_;
  ChainGroup<Space>& chains_;
  std::vector<double> fed_;                     ///< by a step; none where nothing held changes
  std::vector<TendonConstraint> from_, rates_;  ///< held at λ = 0, and its change; none where that stays
};

template <class Space>
bool is_answerable(const ChainLegs<Space>& robot, const ChainState<Space>& state,
                   const ChainCurveOptions<Space>& how) {
  if (!fits(robot, state)) return false;
  if (!how.added_wrench.allFinite() || !(how.lowest <= 0) || !(how.highest >= 0) || how.max_points <= 0 ||
      how.max_total_points <= 0)
    return false;
  if (how.hold.empty()) return !how.added_wrench.isZero(0);
  if (how.hold.size() != state.hold.size() || !check_hold(robot, std::span(how.hold)).ok()) return false;
  double change = how.added_wrench.norm();
  for (std::size_t i = 0; i < how.hold.size(); ++i) {
    if (how.hold[i].length_of != state.hold[i].length_of) return false;
    const TendonConstraint rate = difference(state.hold[i], how.hold[i]);
    change += std::abs(rate.length) + std::abs(rate.tension[0]) + std::abs(rate.tension[1]);
  }
  return std::isfinite(change) && change > 0;
}

}  // namespace

template <class Space>
std::vector<ChainCurve<Space>> chain_curves(const ChainLegs<Space>& robot, const ChainState<Space>& state,
                                            const ChainCurveOptions<Space>& how, ChainWork& work) {
  if (!is_answerable(robot, state, how) || !check_hold(robot, std::span(state.hold)).ok()) return {};
  auto& memory = memory_of(work, robot, state);
  memory.group.evaluate();
  memory.group.linearise();
  if (!memory.group.stiffness().allFinite()) return {};
  using Problem = ChainProblem<Space>;
  Tracer<Problem> tracer(Problem(robot, memory.group, how), 0, memory.places[0], memory.places[1]);
  const CurveRange range{how.lowest,      how.highest,          how.max_points,
                         how.is_backward, how.follows_branches, how.max_total_points};
  return CurveWriter<Problem>(tracer, range, work.stop).run();
}

#define SINEW_OF(Space)                                                                                   \
  template std::vector<ChainCurve<Space>> chain_curves(const ChainLegs<Space>&, const ChainState<Space>&, \
                                                       const ChainCurveOptions<Space>&, ChainWork&);
SINEW_OF(Planar)
SINEW_OF(Spatial)
#undef SINEW_OF

}  // namespace sinew::inline v1
