#include "check_jacobian.hpp"

#include <gtest/gtest.h>

namespace sinew::test {
namespace check_jacobian_test {

constexpr auto bend = []<class S>(const Vec<S, 2>& x) {
  using std::cos, std::sin;
  return Vec<S, 3>(sin(S(x[0] * x[1])), cos(x[0]) * S(1e-2), x[1]);
};

Mat<double, 3, 2> bend_jacobian(const Vec2<double>& x) {
  const double c = std::cos(x[0] * x[1]);
  Mat<double, 3, 2> j;
  j << x[1] * c, x[0] * c, -1e-2 * std::sin(x[0]), 0, 0, 1;
  return j;
}

TEST(CheckJacobian, AcceptsTheDerivative) {
  for (const Vec2<double>& x : {Vec2<double>(0, 0), Vec2<double>(1e-8, -1e-8), Vec2<double>(2, -0.7)}) {
    EXPECT_LT(check_jacobian(bend, x, bend_jacobian(x)), 1e-11);
    EXPECT_LT(jacobian_error(complex_step_jacobian(bend, x), bend_jacobian(x)), 1e-15);
  }
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(4, -1, 2);
  const auto squares = [](const Eigen::VectorXd& at) -> Eigen::VectorXd { return at.cwiseAbs2(); };
  EXPECT_LT(check_jacobian_real(squares, x, Eigen::MatrixXd((2 * x).asDiagonal())), 1e-11);
}

TEST(CheckJacobian, SeesASmallMistakeInASmallRow) {
  const Vec2<double> x(1, 2);
  auto wrong = bend_jacobian(x);
  wrong(1, 0) *= 1 + 1e-6;
  EXPECT_NEAR(check_jacobian(bend, x, wrong), 1e-6, 1e-9);
}

TEST(CheckJacobian, CallsShapesAndNanWrong) {
  const Vec2<double> x(1, 2);
  EXPECT_TRUE(std::isinf(check_jacobian(bend, x, bend_jacobian(x).transpose())));
  EXPECT_TRUE(std::isinf(check_jacobian(bend, x, bend_jacobian(x) * std::nan(""))));
}

}  // namespace check_jacobian_test
}  // namespace sinew::test
