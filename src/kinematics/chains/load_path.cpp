/// Loads on platforms on chains that grow until they cannot.
#include <algorithm>
#include <cmath>

#include "kinematics/chains/path.hpp"
#include "solve/growing_load.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v0 {

std::string_view to_string(ChainLoadEnd end) noexcept {
  constexpr std::string_view names[] = {"limit", "fold", "bifurcation", "slack", "iterations", "stability"};
  return names[static_cast<std::size_t>(end)];
}

namespace {

/// What the solver of growing loads asks of chains (solve/tracer.hpp, growing_load.hpp): legs eliminated,
/// unknowns are the platform's motion, turns over the longest chain.
template <class Space>
class ChainProblem {
 public:
  static constexpr int unknowns = Space::dof;
  using State = LimbState;
  struct Place {
    State state;
    double lambda = 0;
    Vec<double, unknowns + 1> tangent = Vec<double, unknowns + 1>::Zero();
  };
  using Motion = Vec<double, unknowns>;

  /// @param load is added to the group's wrench, λ times
  ChainProblem(ChainGroup<Space>& group, const Motion& load)
      : group_(group),
        first_(group.wrench()),
        load_(load) {
    for (int k = 0; k < group.limbs(); ++k) unit_ += group.stiffness(k) / std::pow(group.length(k), 3);
  }

  void save(State& to) const { group_.save(to); }
  void restore(const State& from) { group_.restore(from); }
  double evaluate() { return group_.evaluate(); }
  bool linearise() {
    group_.linearise();
    return group_.stiffness().allFinite();
  }
  bool refine() { return false; }
  double tolerance() const { return chain_tolerance; }
  double rounding() const { return chain_rounding; }
  double size() const { return group_.radius(); }
  double unit() const { return unit_; }  ///< Σ EI/ℓ³
  double longest_scale() const { return std::max(size(), per_length(load_).norm() / unit_); }

  std::array<double, static_cast<std::size_t>(unknowns*(unknowns + 1))> equations(double scale) const {
    std::array<double, static_cast<std::size_t>(unknowns * (unknowns + 1))> rows;
    Eigen::Map<Eigen::Matrix<double, unknowns, unknowns + 1, Eigen::RowMajor>> to(rows.data());
    for (int k = 0; k < unknowns; ++k)
      to.col(k) = per_length(group_.stiffness().col(k)) / (k < Space::dimension ? 1 : size());
    to.col(unknowns) = per_length(load_) / -scale;
    return rows;
  }
  Motion missing() const { return per_length(group_.wrench_residual()); }
  void move(const Motion& step, double lambda, double change) {
    group_.move(per_length(step));
    put(lambda + change);
  }
  void put(double lambda) { group_.set_wrench(first_ + lambda * load_); }
  /// By the inertia of a Schur complement.
  CurveSigns signs() const {
    const auto rows = equations(1);
    Eigen::Matrix<double, unknowns, unknowns, Eigen::RowMajor> S;
    for (int k = 0; k < unknowns * unknowns; ++k)
      S.data()[k] = rows[static_cast<std::size_t>(k + k / unknowns)];
    std::array<double, static_cast<std::size_t>(unknowns)> values;
    symmetric_eigenvalues(MatrixView(S.data(), unknowns, unknowns), values);
    CurveSigns signs;
    for (int k = 0; k < group_.limbs(); ++k) signs.own += group_.unstable_with_tip_held(k)[0];
    signs.unstable = signs.own;
    for (const double value : values) signs.unstable += value < 0;
    return signs;
  }
  int giving_way(const CurveSigns& signs) const { return signs.unstable; }
  bool is_symmetric() const {
    return Space::dimension == 2 || group_.wrench().template tail<unknowns - Space::dimension>().isZero(0);
  }
  double margin() const { return group_.margin(); }

 private:
  /// Moments as forces, turns as lengths back to turns.
  Motion per_length(Motion of) const {
    of.template tail<unknowns - Space::dimension>() /= size();
    return of;
  }

  ChainGroup<Space>& group_;
  Motion first_, load_;
  double unit_ = 0;
};

}  // namespace

template <class Space>
ChainLoadPath follow_load(const ChainRobot<Space>& robot, const Vec<double, Space::dof>& direction,
                          double limit, ChainState<Space>& state, ChainWork& work,
                          const ChainOptions& options) {
  ChainLoadPath path;
  if (!fits(robot, state)) {
    path.report.status = Status::bad_input;
    path.report.message.append("the state is of another robot");
    return path;
  }
  if (!direction.allFinite() || std::isnan(limit)) {
    path.report.status = Status::bad_input;
    path.report.message.append("the direction of the load, or its limit, is not a number");
    return path;
  }
  path.report = check_hold(robot, state.hold);
  if (!path.report.ok()) return path;
  auto& group = memory_of(work, robot, state, options).group;
  group.evaluate();
  group.linearise();
  check_regularity(regularity(group), path.report);
  if (!path.report.ok()) return path;
  if (!(limit > 0) || direction.isZero(0)) {  // nothing grows
    path.load = std::max(limit, 0.0);
    return path;
  }
  double bending = 0;  // a force that bends the chains, roughly
  for (const auto& leg : robot.legs) bending += leg.bending_stiffness / std::pow(leg.chain.length, 2);
  const double largest = direction.cwiseAbs().maxCoeff(), unit = bending / largest;
  using Problem = ChainProblem<Space>;
  const Vec<double, Space::dof> load = direction / largest * bending;
  typename Problem::Place places[4];
  Tracer<Problem> tracer({group, load}, 0, places[0], places[1]);
  const Growth grown = GrowingLoad<Problem>(tracer, places[2], places[3]).run(limit / unit, work.stop, [&] {
    return tracer.iterations() < options.max_iterations;
  });
  using End = ChainLoadEnd;
  constexpr End ends[] = {End::limit, End::fold, End::bifurcation, End::stability,
                          End::slack, End::fold, End::iterations,  End::iterations};
  path.end = ends[static_cast<int>(grown.end)];
  path.load = grown.end == GrowthEnd::limit ? limit : grown.parameter * unit;
  group.measure();
  state = group.state();
  path.report.residual = group.evaluate() * group.radius();
  path.report.iterations = tracer.iterations();
  if (!note_stop(work.stop, path.report) && grown.end == GrowthEnd::ran_out) {
    path.report.status = Status::iteration_limit;
    path.report.message.append("the iterations ran out before the load stopped growing");
  }
  return path;
}

#define SINEW_OF(Space)                                                                                  \
  template SINEW_API ChainLoadPath follow_load(const ChainRobot<Space>&, const Vec<double, Space::dof>&, \
                                               double, ChainState<Space>&, ChainWork&, const ChainOptions&);
SINEW_OF(Planar)
SINEW_OF(Spatial)
#undef SINEW_OF

}  // namespace sinew::inline v0
