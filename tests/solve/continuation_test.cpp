/// Continuation on curves known in closed form.
#include "solve/continuation.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <vector>

#include "math/linalg.hpp"
#include "solve/curve_writer.hpp"
#include "solve/growing_load.hpp"

namespace sinew::test {
namespace continuation_test {

/// Equations f(x, λ) = 0, each the derivative of a potential by one unknown, with [∂f/∂x ∂f/∂λ].
template <int N>
struct Equations {
  Vec<double, N> f;
  Mat<double, N, N + 1> slope;
};
template <int N>
using Formula = Equations<N> (*)(const Vec<double, N>& x, double lambda);

template <int N>
class Problem {
 public:
  static constexpr int unknowns = N;
  using X = Vec<double, N>;
  using Rows = std::array<double, static_cast<std::size_t>(N*(N + 1))>;
  struct State {
    X x;
    double lambda;
  };
  struct Place {
    State state;
    double lambda;
    Vec<double, N + 1> tangent;
  };
  struct Point {
    CurveMark event;
    double lambda;
    X x;
    int unstable;
  };
  struct Curve {
    std::vector<Point> points = {};
    CurveStop end = CurveStop::stuck;
    int from_curve = -1, from_point = -1;
  };

  Problem(Formula<N> formula, const X& x, double margin_until = std::numeric_limits<double>::infinity())
      : formula_(formula),
        state_{x, 0},
        margin_until_(margin_until) {}

  const X& x() const { return state_.x; }
  Place place() const { return {state_, 0, {}}; }
  void save(State& to) const { to = state_; }
  void restore(const State& from) { state_ = from; }
  double evaluate() {
    now_ = formula_(state_.x, state_.lambda);
    return std::sqrt(squared_norm(now_.f));
  }
  bool linearise() { return true; }
  bool refine() { return false; }
  double tolerance() const { return 1e-13; }
  double rounding() const { return tolerance(); }
  double size() const { return 1; }
  double unit() const { return 1; }
  double longest_scale() const { return 1; }
  Rows equations(double scale) const {
    Rows rows;
    for (int r = 0; r < N; ++r)
      for (int c = 0; c <= N; ++c)
        rows[static_cast<std::size_t>((N + 1) * r + c)] = now_.slope(r, c) / (c < N ? 1 : scale);
    return rows;
  }
  X residual() const { return -now_.f; }
  void move(const X& step, double lambda, double change) {
    state_.x += step;
    put(lambda + change);
  }
  void put(double lambda) { state_.lambda = lambda; }
  CurveSigns signs() const {
    Eigen::Matrix<double, N, N, Eigen::RowMajor> A = now_.slope.template leftCols<N>();
    std::array<double, static_cast<std::size_t>(N)> values;
    symmetric_eigenvalues(MatrixView(A.data(), N, N), values);
    CurveSigns signs;
    for (const double value : values) signs.unstable += value < 0;
    return signs;
  }
  int giving_way(const CurveSigns& signs) const { return signs.unstable; }
  bool is_symmetric() const { return true; }
  double margin() const { return margin_until_ - state_.lambda; }
  Point point(double lambda, double, CurveMark mark, int unstable) const {
    return {mark, lambda, state_.x, unstable};
  }
  bool is_same(const Point& a, const Point& b) const { return (a.x - b.x).norm() < 1e-8; }
  X way_from(const State& state) const { return (state_.x - state.x).normalized(); }
  bool is_far() const { return state_.x.norm() > 10; }
  CurveStop end_of(CurveStop stop) const { return stop; }

 private:
  Formula<N> formula_;
  State state_;
  Equations<N> now_;
  double margin_until_;
};

template <int N>
std::vector<typename Problem<N>::Curve> curves_of(const Problem<N>& problem, const CurveRange& range,
                                                  StopToken stop = {}) {
  auto before = problem.place(), origin = before;
  Tracer<Problem<N>> tracer(problem, 0, before, origin);
  return CurveWriter<Problem<N>>(tracer, range, stop).run();
}

template <int N>
Growth grown(const Problem<N>& problem, double highest = 2, StopToken stop = {}, int most = 4000) {
  auto before = problem.place(), origin = before, begun = before, reached = before;
  Tracer<Problem<N>> tracer(problem, 0, before, origin);
  int steps = 0;
  return GrowingLoad<Problem<N>>(tracer, begun, reached).run(highest, stop, [&] { return steps++ < most; });
}

using One = Vec<double, 1>;
using Two = Vec<double, 2>;
using Row = Mat<double, 1, 2>;
One one(double x) { return One::Constant(x); }

/// x² + (λ − 1/2)² = 1: folds at λ = −1/2 and 3/2.
Equations<1> circle(const One& x, double l) {
  return {one(x[0] * x[0] + (l - 0.5) * (l - 0.5) - 1), Row{{2 * x[0], 2 * l - 1}}};
}
const One on_circle = one(std::sqrt(0.75));

/// With y beside x, which moves with λ: y = λ + x²/2.
Equations<2> beside(double f, double by_x, const Two& x, double l) {
  return {Two(f, x[1] - x[0] * x[0] / 2 - l), Mat<double, 2, 3>{{by_x, -x[0], 0}, {-x[0], 1, -1}}};
}
constexpr double crossing = 0.5;  // λ where curves cross
/// x = 0, and x² = 2 (λ − 1/2).
Equations<2> pitchfork(const Two& x, double l) {
  const double m = x[1] - crossing;
  return beside(x[0] * x[0] * x[0] - m * x[0], 3 * x[0] * x[0] - m, x, l);
}
template <int exponent>  // imperfect by 10^-exponent
Equations<2> imperfect(const Two& x, double l) {
  Equations<2> at = pitchfork(x, l);
  at.f[0] -= std::pow(10, -exponent);
  return at;
}
/// x = 0, and λ = 1/2 + x − x²/2; they exchange their stability.
Equations<2> transcritical(const Two& x, double l) {
  const double m = x[1] - crossing;
  return beside(x[0] * x[0] - m * x[0], 2 * x[0] - m, x, l);
}
using Three = Vec<double, 3>;
/// The pitchfork turned about: two directions give way at once.
Equations<3> bowl(const Three& x, double l) {
  const double square = x[0] * x[0] + x[1] * x[1], s = square - x[2] + crossing;
  return {Three(s * x[0], s * x[1], x[2] - square / 2 - l),
          Mat<double, 3, 4>{{s + 2 * x[0] * x[0], 2 * x[0] * x[1], -x[0], 0},
                            {2 * x[0] * x[1], s + 2 * x[1] * x[1], -x[1], 0},
                            {-x[0], -x[1], 1, -1}}};
}
constexpr double end_of_domain = 0.7;
Equations<1> ending(const One& x, double l) {
  return {one(l > end_of_domain ? std::numeric_limits<double>::quiet_NaN() : x[0] - l * l), Row{{1, -2 * l}}};
}

template <class Curve>
std::vector<double> lambdas_of(const Curve& curve, CurveMark mark) {
  std::vector<double> lambdas;
  for (const auto& point : curve.points)
    if (point.event == mark) lambdas.push_back(point.lambda);
  return lambdas;
}

TEST(Curves, ACircleTurnsBackTwiceAndCloses) {
  const auto curves = curves_of(Problem<1>(circle, on_circle), {-2, 2});
  ASSERT_EQ(curves.size(), 1);
  EXPECT_EQ(curves[0].end, CurveStop::closed);
  const auto folds = lambdas_of(curves[0], CurveMark::fold);
  ASSERT_EQ(folds.size(), 2);
  EXPECT_NEAR(folds[0], 1.5, 1e-13);
  EXPECT_NEAR(folds[1], -0.5, 1e-13);
  EXPECT_EQ(lambdas_of(curves[0], CurveMark::target), std::vector<double>({1, 1}));
  EXPECT_EQ(lambdas_of(curves[0], CurveMark::begin), std::vector<double>({0, 0, 0}));
  for (const auto& point : curves[0].points)
    EXPECT_NEAR(std::hypot(point.x[0], point.lambda - 0.5), 1, 1e-13);
}

TEST(Curves, BackwardBeginsWithAFallingParameter) {
  const auto curves = curves_of(Problem<1>(circle, on_circle), {-2, 2, 500, true});
  EXPECT_NEAR(lambdas_of(curves[0], CurveMark::fold).front(), -0.5, 1e-13);
}

TEST(Curves, APitchforkHasTwoMoreBranches) {
  const auto curves = curves_of(Problem<2>(pitchfork, Two::Zero()), {0, 1, 500, false, true});
  ASSERT_EQ(curves.size(), 3);
  const auto met = lambdas_of(curves[0], CurveMark::bifurcation);
  ASSERT_EQ(met.size(), 1);
  EXPECT_NEAR(met[0], crossing, 1e-10);
  EXPECT_EQ(curves[0].points.back().unstable, 1);
  EXPECT_EQ(curves[0].points.back().event, CurveMark::target);
  for (std::size_t k = 1; k < 3; ++k) {
    EXPECT_EQ(curves[k].from_curve, 0);
    EXPECT_EQ(curves[0].points[static_cast<std::size_t>(curves[k].from_point)].event, CurveMark::bifurcation);
    EXPECT_EQ(curves[k].end, CurveStop::left_range);
    EXPECT_NEAR(std::abs(curves[k].points.back().x[0]), 1, 1e-12);
    EXPECT_EQ(curves[k].points.back().unstable, 0);
  }
  EXPECT_LT(curves[1].points.back().x[0] * curves[2].points.back().x[0], 0);
}

TEST(Curves, ATranscriticalCrossingIsPassedStraightOn) {
  const auto curves = curves_of(Problem<2>(transcritical, Two::Zero()), {0, 0.9, 500, false, true});
  ASSERT_EQ(curves.size(), 3);  // the other one, both ways
  EXPECT_NEAR(lambdas_of(curves[0], CurveMark::bifurcation).at(0), crossing, 1e-10);
  EXPECT_NEAR(curves[0].points.back().x[0], 0, 1e-15);
  for (std::size_t k = 1; k < 3; ++k)
    for (const auto& point : curves[k].points)
      EXPECT_NEAR(point.lambda, crossing + point.x[0] - point.x[0] * point.x[0] / 2, 1e-12);
}

/// However near the other curve passes, this one is not left.
TEST(Curves, OneThatPassesNearIsNotTaken) {
  const Formula<2> formulas[] = {imperfect<2>, imperfect<4>, imperfect<6>, imperfect<8>};
  for (int k = 0; k < 4; ++k) {
    const double apart = std::pow(10, -2 * (k + 1));
    double x = apart / crossing;
    for (int i = 0; i < 20; ++i) x -= (x * x * x / 2 + crossing * x - apart) / (1.5 * x * x + crossing);
    const Problem<2> problem(formulas[k], Two(x, x * x / 2));
    const auto curves = curves_of(problem, {0, 1});
    EXPECT_EQ(curves[0].end, CurveStop::left_range) << apart;
    EXPECT_TRUE(lambdas_of(curves[0], CurveMark::bifurcation).empty()) << apart;
    EXPECT_GT(curves[0].points.back().x[0], 1) << apart;
    EXPECT_EQ(curves[0].points.back().unstable, 0);
    EXPECT_EQ(grown(problem, 1).end, GrowthEnd::limit);
  }
}

TEST(Curves, EndWhereTheEquationsDo) {
  const auto curves = curves_of(Problem<1>(ending, one(0)), {0, 1});
  EXPECT_EQ(curves[0].end, CurveStop::stuck);
  EXPECT_NEAR(curves[0].points.back().lambda, end_of_domain, 1e-6);
  const Growth growth = grown(Problem<1>(ending, one(0)));
  EXPECT_EQ(growth.end, GrowthEnd::lost);
  EXPECT_NEAR(growth.parameter, end_of_domain, 1e-6);
}

TEST(Curves, StopOnRequestAndAtTheirBounds) {
  const std::atomic<bool> asked{true};
  const auto curves = curves_of(Problem<1>(circle, on_circle), {-2, 2}, StopToken(asked));
  EXPECT_EQ(curves[0].end, CurveStop::stopped);
  EXPECT_EQ(curves[0].points.size(), 1);
  EXPECT_EQ(curves_of(Problem<1>(circle, on_circle), {-2, 2, 3})[0].end, CurveStop::max_points);
  EXPECT_EQ(grown(Problem<1>(circle, on_circle), 2, StopToken(asked)).end, GrowthEnd::stopped);
  const Growth short_of = grown(Problem<1>(circle, on_circle), 2, {}, 3);
  EXPECT_EQ(short_of.end, GrowthEnd::ran_out);
  EXPECT_GT(short_of.parameter, 0);
}

std::atomic<bool> asked_at_the_end;
Equations<2> asking_at_the_end(const Two& x, double l) {
  if (l >= 1) asked_at_the_end = true;
  return pitchfork(x, l);
}

/// The first curve is whole then: one that has not left it tells that others were not looked for.
TEST(Curves, StopBetweenTwoCurvesAsWell) {
  const CurveRange range{0, 1, 500, false, true};
  const auto all = curves_of(Problem<2>(pitchfork, Two::Zero()), range);
  asked_at_the_end = false;
  const auto curves =
      curves_of(Problem<2>(asking_at_the_end, Two::Zero()), range, StopToken(asked_at_the_end));
  ASSERT_EQ(curves.size(), 2);
  EXPECT_EQ(curves[0].end, all[0].end);
  EXPECT_EQ(curves[0].points.size(), all[0].points.size());
  EXPECT_EQ(curves[1].end, CurveStop::stopped);
  ASSERT_EQ(curves[1].points.size(), 1);
  EXPECT_EQ(curves[1].points[0].event, CurveMark::bifurcation);
  EXPECT_EQ(curves[1].from_point, all[1].from_point);
}

/// No curve is left out without a word: one of a single point stands where others would leave.
TEST(Curves, AreToldWhereTheyAreTooManyToFollow) {
  CurveRange range{0, 1, 500, false, true};
  const auto all = curves_of(Problem<2>(pitchfork, Two::Zero()), range);
  ASSERT_EQ(all.size(), 3);
  range.max_total_points = static_cast<int>(all[0].points.size()) + 1;
  const auto some = curves_of(Problem<2>(pitchfork, Two::Zero()), range);
  ASSERT_EQ(some.size(), 3);  // the second one is begun, and followed to its end
  EXPECT_EQ(some[1].end, all[1].end);
  EXPECT_EQ(some[1].points.size(), all[1].points.size());
  EXPECT_EQ(some[2].end, CurveStop::not_followed);
  ASSERT_EQ(some[2].points.size(), 1);
  EXPECT_EQ(some[2].points[0].event, CurveMark::bifurcation);
  EXPECT_EQ(some[2].from_point, all[2].from_point);
}

TEST(GrowingLoads, SayWhatEndsThem) {
  const Growth fold = grown(Problem<1>(circle, on_circle));
  EXPECT_EQ(fold.end, GrowthEnd::fold);
  EXPECT_NEAR(fold.parameter, 1.5, 1e-12);
  for (const Formula<2> formula : {pitchfork, transcritical}) {
    const Growth growth = grown(Problem<2>(formula, Two::Zero()));
    EXPECT_EQ(growth.end, GrowthEnd::bifurcation);
    EXPECT_NEAR(growth.parameter, crossing, 1e-9);
    EXPECT_LE(growth.parameter, crossing);  // the last that holds
  }
  const Growth both = grown(Problem<3>(bowl, Three::Zero()));  // the determinant keeps its sign
  EXPECT_EQ(both.end, GrowthEnd::bifurcation);
  EXPECT_NEAR(both.parameter, crossing, 1e-9);
  const Growth limit = grown(Problem<1>(circle, on_circle), 0.99);
  EXPECT_EQ(limit.end, GrowthEnd::limit);
  EXPECT_EQ(limit.parameter, 0.99);
  const Growth bound = grown(Problem<1>(circle, on_circle, 0.3));
  EXPECT_EQ(bound.end, GrowthEnd::bound);
  EXPECT_NEAR(bound.parameter, 0.3, 1e-9);
}

/// A limit that lies between the last step and the fold is met, one just beyond the fold is not.
TEST(GrowingLoads, TellALimitFromAFoldNextToIt) {
  EXPECT_EQ(grown(Problem<1>(circle, on_circle), 1.5 - 1e-9).end, GrowthEnd::limit);
  EXPECT_EQ(grown(Problem<1>(circle, on_circle), 1.5 + 1e-9).end, GrowthEnd::fold);
}

ParameterStep reached(double next) { return {ParameterStep::reached, next, 1}; }

TEST(Parameter, ArrivesExactly) {
  ParameterPath path;
  double sum = 0, last = 0;
  follow_parameter(path, {{0.3}, 0, 100}, [&](double next, double taken) {
    ++path.iterations;
    sum += taken;
    last = next;
    return reached(1.7 * taken);
  });
  EXPECT_TRUE(path.arrived);
  EXPECT_EQ(path.progress, 1);
  EXPECT_EQ(last, 1);
  EXPECT_NEAR(sum, 1, 1e-15);
  EXPECT_EQ(path.iterations, 3);
}

TEST(Parameter, EndsWhereNoStepSucceeds) {
  constexpr double wall = 0.6180339887;
  ParameterPath path;
  follow_parameter(path, {{1, 1e-9}, 0, 1000}, [&](double next, double taken) {
    ++path.iterations;
    return next > wall ? ParameterStep{ParameterStep::failed, taken / 4} : reached(2 * taken);
  });
  EXPECT_FALSE(path.arrived || path.ran_out || path.stopped);
  EXPECT_NEAR(path.progress, wall, 1e-8);
  EXPECT_LE(path.progress, wall);
}

TEST(Parameter, EndsByBudgetByRequestAndWhereItIsGivenUp) {
  ParameterPath path;
  follow_parameter(path, {{0.01}, 0, 5}, [&](double, double taken) {
    ++path.iterations;
    return reached(taken);
  });
  EXPECT_TRUE(path.ran_out);
  EXPECT_NEAR(path.progress, 0.05, 1e-15);
  std::atomic<bool> asked{false};
  path = {};
  follow_parameter(path, {{0.01, 0, StopToken(asked)}, 0, 5}, [&](double, double taken) {
    asked = true;
    return reached(taken);
  });
  EXPECT_TRUE(path.stopped);
  EXPECT_NEAR(path.progress, 0.01, 1e-15);
  for (const double next : {0.0, std::numeric_limits<double>::quiet_NaN()}) {
    path = {};
    int calls = 0;
    follow_parameter(path, {{1, 0}, 0, 5}, [&](double, double) {
      ++calls;
      return ParameterStep{ParameterStep::failed, next};
    });
    EXPECT_FALSE(path.arrived || path.ran_out || path.stopped);
    EXPECT_EQ(calls, 1);
  }
}

/// Over a place where signs change no long step is believed, and beyond it strides are long again.
TEST(Parameter, HalvesStepsOverAChangeOfSigns) {
  constexpr double place = 0.35, verifiable = 1e-6;
  ParameterPath path;
  double over = 0, longest_after = 0;
  int steps = 0;
  follow_parameter(path, {{0.25, 1e-9}, 0, 1000}, [&](double next, double taken) {
    ++steps;
    const bool crosses = path.progress < place && next >= place;
    if (crosses && taken > verifiable) return ParameterStep{ParameterStep::crossed, 0, verifiable};
    if (crosses) over = taken;
    if (!crosses && next > place) longest_after = std::max(longest_after, taken);
    return ParameterStep{crosses ? ParameterStep::reached_other_side : ParameterStep::reached, taken,
                         verifiable};
  });
  EXPECT_TRUE(path.arrived);
  EXPECT_GT(over, 0);
  EXPECT_LE(over, verifiable);
  EXPECT_EQ(longest_after, 0.25);
  EXPECT_LT(steps, 60);
}

TEST(Newton, ContractsOrSaysThatItDoesNot) {
  double x = 3, residual = -1;
  int iterations = 0;
  const auto error = [&] { return std::abs(x * x - 2); };
  const auto step = [&] {
    x -= (x * x - 2) / (2 * x);
    return true;
  };
  EXPECT_TRUE(contract(error, step, 1e-12, 1e-15, iterations, residual));
  EXPECT_NEAR(x, std::sqrt(2), 1e-15);
  EXPECT_LT(residual, 1e-15);
  EXPECT_LE(iterations, 6);
  const auto creep = [&] {
    x *= 0.999;
    return true;
  };
  x = 3, residual = -1;
  EXPECT_FALSE(contract(error, creep, 1e-12, 1e-15, iterations, residual));
  EXPECT_EQ(residual, -1);
  EXPECT_FALSE(contract(
      error, [] { return false; }, 1e-12, 1e-15, iterations, residual));
  x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(contract(error, step, 1e-12, 1e-15, iterations, residual));
}

}  // namespace continuation_test
}  // namespace sinew::test
