// Fits of several columns with the same coefficients.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>

#include "study_support.hpp"

namespace joint_fit_test {

using namespace sinew;
using test::column;
using test::Folder;
using test::study_of;
using test::sweep_to;

const std::string study = R"(sinew: 1
robot: 3-frr
query: {query: inverse, pose: {x: $x, y: $y, phi: 0.1}}
axes: {y: {from: -30 mm, to: 35 mm, count: 31}, x: {from: -20 mm, to: 30 mm, count: 33}}
outputs: {l0: "inputs[0]", l1: "inputs[1]"}
)";
const std::string formulas = R"(    of:
      l0: c1 + c2*x + 2 c3*x*y
      l1: c1 - c2*y + 0.5*x*c3*x - y^2*c3
)";

std::string code_of(const std::string& fit) {
  const Folder folder;
  const auto read = study_of(folder, study + "fits: {f: " + fit + "}\n");
  return read ? "" : read.error().front().code;
}

/// The equations of all samples, one under the other.
struct Dense {
  Eigen::MatrixXd rows;
  Eigen::VectorXd right;
};
Dense dense(const Table& table) {
  const auto n = static_cast<Eigen::Index>(table.row_count());
  Dense all{Eigen::MatrixXd(2 * n, 3), Eigen::VectorXd(2 * n)};
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto at = [&](const char* name) { return column(table, name).values[static_cast<std::size_t>(k)]; };
    const double x = at("x"), y = at("y");
    all.rows.row(k) << 1, x, 2 * x * y;
    all.rows.row(n + k) << 1, -y, 0.5 * x * x - y * y;
    all.right[k] = at("l0");
    all.right[n + k] = at("l1");
  }
  return all;
}

TEST(JointFit, IsTheLeastSquaresOfAllItsEquations) {
  const Folder folder;
  const auto done =
      sweep_to(folder, study + "fits:\n  f:\n    coefficients: [c1, c2, c3]\n" + formulas, "out.h5");
  ASSERT_TRUE(done) << to_string(done.error());
  const auto table = read_result(folder.path / "out.h5");
  ASSERT_TRUE(table);
  const auto [rows, right] = dense(*table);
  const Eigen::VectorXd solution = rows.colPivHouseholderQr().solve(right);
  const Eigen::VectorXd left = right - rows * solution;
  const Eigen::Index n = rows.rows() / 2;
  const Eigen::MatrixXd inverse = (rows.transpose() * rows).inverse();
  const FittedTerms& fit = done->fits[0];
  ASSERT_EQ(fit.terms, (std::vector<std::string>{"c1", "c2", "c3"}));
  for (Eigen::Index t = 0; t < 3; ++t) {
    const auto c = static_cast<std::size_t>(t);
    EXPECT_NEAR(fit.coefficients[c], solution[t], 1e-10 * std::abs(solution[t]));
    const double deviation = std::sqrt(left.squaredNorm() / static_cast<double>(2 * n - 3) * inverse(t, t));
    EXPECT_NEAR(fit.deviations[c], deviation, 1e-8 * deviation);
  }
  EXPECT_EQ(fit.samples, static_cast<std::size_t>(n));
  EXPECT_NEAR(fit.rms, left.norm() / std::sqrt(static_cast<double>(2 * n)), 1e-12);
  EXPECT_NEAR(fit.largest, left.cwiseAbs().maxCoeff(), 1e-12);
  ASSERT_EQ(fit.columns.size(), 2U);
  for (std::size_t e = 0; e < 2; ++e) {
    const auto own = left.segment(static_cast<Eigen::Index>(e) * n, n);
    const double size = right.segment(static_cast<Eigen::Index>(e) * n, n).norm();
    EXPECT_NEAR(fit.columns[e].rms, own.norm() / std::sqrt(static_cast<double>(n)), 1e-12);
    EXPECT_NEAR(fit.columns[e].largest, own.cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_NEAR(fit.columns[e].relative, own.norm() / size, 1e-12);
  }
  EXPECT_EQ(fit.columns[1].name, "l1");
  EXPECT_EQ(fit.columns[1].unit, "m");
  EXPECT_EQ(fit.unit, "m");
}

TEST(JointFit, FindsTheCoefficientsOfAnExactLaw) {
  const Folder folder;
  const auto done = sweep_to(folder, study + R"(derived:
  u: 0.3*y + 0.8*x*y + 0.7*y^3 + 0.7*x^2*y
  v: "-0.3*x + 0.4*x^2 - 0.4*y^2 - 0.7*x^3 - 0.7*x*y^2"
fits:
  law:
    coefficients: [c1, c2, c3]
    of: {u: "c1*y + 2 c2*x*y + c3*y^3 + c3*x^2*y", v: "-c1*x + c2*x^2 - c2*y^2 - c3*x^3 - c3*x*y^2"}
  given:
    known: {c1: 0.3, c2: 0.4, c3: 0.7}
    of: {u: "c1*y + 2 c2*x*y + c3*y^3 + c3*x^2*y"}
)",
                             "out.csv");
  ASSERT_TRUE(done) << to_string(done.error());
  const std::array<double, 3> law{0.3, 0.4, 0.7};
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(done->fits[0].coefficients[c], law[c], 1e-10);
  EXPECT_LT(done->fits[0].largest, 1e-16);
  EXPECT_LT(done->fits[1].largest, 1e-17);
  const std::string text = test::bytes(folder.path / "out.csv");
  EXPECT_NE(text.find("# fit given: c1 = 0.3, c2 = 0.4, c3 = 0.7 (given); 1023 samples\n"),
            std::string::npos);
  EXPECT_NE(text.find("#   u = c1*y + 2 c2*x*y + c3*y^3 + c3*x^2*y; rms "), std::string::npos);
}

TEST(JointFit, GivenCoefficientsHaveTheirResiduals) {
  const Folder folder;
  const auto done =
      sweep_to(folder, study + "fits:\n  f:\n    known: {c1: 0.1, c2: -0.2, c3: 0.3}\n" + formulas, "out.h5");
  ASSERT_TRUE(done) << to_string(done.error());
  const auto table = read_result(folder.path / "out.h5");
  ASSERT_TRUE(table);
  const auto [rows, right] = dense(*table);
  const Eigen::VectorXd left = right - rows * Eigen::Vector3d(0.1, -0.2, 0.3);
  const FittedTerms& fit = done->fits[0];
  EXPECT_TRUE(fit.is_given);
  EXPECT_EQ(fit.coefficients, (std::vector<double>{0.1, -0.2, 0.3}));
  EXPECT_TRUE(std::isnan(fit.deviations[0]));
  EXPECT_EQ(fit.samples, table->row_count());
  EXPECT_NEAR(fit.rms, left.norm() / std::sqrt(static_cast<double>(left.size())), 1e-12);
  EXPECT_NEAR(fit.largest, left.cwiseAbs().maxCoeff(), 1e-12);
}

/// One column whose coefficients are one a term is the short form.
TEST(JointFit, OfOneColumnIsTheShortForm) {
  const Folder folder;
  const auto done = sweep_to(folder, study + R"(fits:
  l0: {terms: [x, x*y - y, 1]}
  f: {coefficients: [a, b, c], of: {l0: a*x + b*x*y - b*y + c}}
)",
                             "out.h5");
  ASSERT_TRUE(done) << to_string(done.error());
  EXPECT_EQ(done->fits[0].coefficients, done->fits[1].coefficients);
  EXPECT_EQ(done->fits[0].deviations, done->fits[1].deviations);
  EXPECT_EQ(done->fits[0].columns[0].relative, done->fits[1].columns[0].relative);
}

TEST(JointFit, CoefficientsThatAreNotToldApartHaveNone) {
  const Folder folder;
  const auto done =
      sweep_to(folder, study + "fits: {f: {coefficients: [a, b], of: {l0: a*x + 2 b*x, l1: a*y + 2 b*y}}}\n",
               "out.csv");
  ASSERT_TRUE(done) << to_string(done.error());
  EXPECT_TRUE(std::isnan(done->fits[0].coefficients[0]));
}

TEST(JointFit, SaysWhatIsWrong) {
  for (const auto& [fit, code] : {std::pair{"{coefficients: [a], of: {l0: a*x}}", ""},
                                  {"{coefficients: [a], of: {l0: a*x + 1}}", "bad_term"},
                                  {"{coefficients: [a], of: {l0: a^2*x}}", "bad_term"},
                                  {"{coefficients: [a, b], of: {l0: a*b*x}}", "bad_term"},
                                  {"{coefficients: [a], of: {l0: a*z}}", "unknown_column"},
                                  {"{coefficients: [a], of: {z: a*x}}", "unknown_column"},
                                  {"{coefficients: [a, b], of: {l0: a*x}}", "unused_coefficient"},
                                  {"{coefficients: [x], of: {l0: x}}", "duplicate_column"},
                                  {"{coefficients: [a, a], of: {l0: a}}", "duplicate_column"},
                                  {"{coefficients: [1a], of: {l0: x}}", "bad_name"},
                                  {"{coefficients: [], of: {l0: x}}", "empty_list"},
                                  {"{coefficients: [a], of: {}}", "empty_map"},
                                  {"{coefficients: [a], of: l0}", "wrong_type"},
                                  {"{coefficients: [a]}", "missing_key"},
                                  {"{coefficients: [a], known: {a: 1}, of: {l0: a}}", "ambiguous"},
                                  {"{known: {}, of: {l0: x}}", "empty_map"},
                                  {"{known: {a: 1 m}, of: {l0: a}}", "wrong_dimension"},
                                  {"{of: {l0: a*x}}", "missing_key"},
                                  {"{coefficients: [a], of: {l0: a*x}, terms: [1]}", "unknown_key"}})
    EXPECT_EQ(code_of(fit), code) << fit;
}

}  // namespace joint_fit_test
