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
  using State = ChainState<Space>;
  struct Place {
    State state;
    double lambda = 0;
    Vec<double, unknowns + 1> tangent = Vec<double, unknowns + 1>::Zero();
  };
  using Motion = Vec<double, unknowns>;

  /// @param state is moved; @param load is added to its wrench, λ times
  ChainProblem(const ChainRobot<Space>& robot, Solver<Space>& solver, State& state, const Motion& load)
      : solver_(solver),
        state_(state),
        first_(state.wrench),
        load_(load) {
    for (const auto& leg : robot.legs) unit_ += leg.bending_stiffness / std::pow(leg.chain.length, 3);
  }

  void save(State& to) const { to = state_; }
  void restore(const State& from) { state_ = from; }
  double evaluate() {
    reduced_ = solver_.reduce(state_.pose, state_.legs, state_.hold, state_.wrench);
    return solver_.residual();
  }
  bool linearise() { return reduced_.S.allFinite(); }
  bool refine() { return false; }
  double tolerance() const { return 1e-11 * size(); }
  double rounding() const { return 1e-14 * size(); }
  double size() const { return solver_.size(); }
  double unit() const { return unit_; }  ///< Σ EI/ℓ³
  double longest_scale() const { return std::max(size(), per_length(load_).norm() / unit_); }

  std::array<double, static_cast<std::size_t>(unknowns*(unknowns + 1))> equations(double scale) const {
    std::array<double, static_cast<std::size_t>(unknowns * (unknowns + 1))> rows;
    Eigen::Map<Eigen::Matrix<double, unknowns, unknowns + 1, Eigen::RowMajor>> to(rows.data());
    for (int k = 0; k < unknowns; ++k)
      to.col(k) = per_length(reduced_.S.col(k)) / (k < Space::dimension ? 1 : size());
    to.col(unknowns) = per_length(load_) / -scale;
    return rows;
  }
  Motion missing() const { return per_length(-reduced_.g); }
  void move(const Motion& step, double lambda, double change) {
    const Motion motion = per_length(step);
    solver_.move(state_.legs, state_.hold, {motion.data(), unknowns});
    state_.pose = Space::moved(state_.pose, motion);
    put(lambda + change);
  }
  void put(double lambda) { state_.wrench = first_ + lambda * load_; }
  /// By the inertia of a Schur complement, but for what an even number of one leg's own directions would add.
  CurveSigns signs() const {
    const auto rows = equations(1);
    Eigen::Matrix<double, unknowns, unknowns, Eigen::RowMajor> S;
    for (int k = 0; k < unknowns * unknowns; ++k)
      S.data()[k] = rows[static_cast<std::size_t>(k + k / unknowns)];
    std::array<double, static_cast<std::size_t>(unknowns)> values;
    symmetric_eigenvalues(MatrixView(S.data(), unknowns, unknowns), values);
    CurveSigns signs;
    signs.own = signs.unstable = solver_.odd_legs();
    for (const double value : values) signs.unstable += value < 0;
    return signs;
  }
  int giving_way(const CurveSigns& signs) const { return signs.unstable; }
  bool is_symmetric() const {
    return Space::dimension == 2 || state_.wrench.template tail<unknowns - Space::dimension>().isZero(0);
  }
  /// To where a tendon would push.
  double margin() const {
    double least = std::numeric_limits<double>::infinity();
    for (const ChainLegState& leg : state_.legs) least = std::min({least, leg.tension[0], leg.tension[1]});
    return least + slack_tolerance;
  }

 private:
  /// Moments as forces, turns as lengths back to turns.
  Motion per_length(Motion of) const {
    of.template tail<unknowns - Space::dimension>() /= size();
    return of;
  }

  Solver<Space>& solver_;
  State& state_;
  Motion first_, load_;
  typename Solver<Space>::Reduced reduced_{Mat<double, unknowns, unknowns>::Zero(), Motion::Zero()};
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
  Solver<Space> solver(robot, work, options);
  check_regularity(solver, solver.reduce(state.pose, state.legs, state.hold, state.wrench), path.report);
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
  typename Problem::Place places[4] = {{state}, {state}, {state}, {state}};
  Tracer<Problem> tracer({robot, solver, state, load}, 0, places[0], places[1]);
  const Growth grown = GrowingLoad<Problem>(tracer, places[2], places[3]).run(limit / unit, work.stop, [&] {
    return tracer.iterations() < options.max_iterations;
  });
  using End = ChainLoadEnd;
  constexpr End ends[] = {End::limit, End::fold, End::bifurcation, End::stability,
                          End::slack, End::fold, End::iterations,  End::iterations};
  path.end = ends[static_cast<int>(grown.end)];
  path.load = grown.end == GrowthEnd::limit ? limit : grown.parameter * unit;
  measure_tendons(robot, state);
  solver.reduce(state.pose, state.legs, state.hold, state.wrench);
  path.report.residual = solver.residual();
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
