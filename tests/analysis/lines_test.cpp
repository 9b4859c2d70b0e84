#include "sinew/analysis/velocity.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "analysis/lines.hpp"
#include "line_cases.hpp"

namespace sinew::test {
namespace lines_test {

constexpr double pi = 3.14159265358979323846, infinity = std::numeric_limits<double>::infinity(),
                 nan = std::numeric_limits<double>::quiet_NaN();

TypeTwo class_of(const Rows& unit, const V3& reference, double radius) {
  const MatrixView view(unit.data(), unit.rows(), unit.cols());
  return unit.cols() == 3 ? classify(view, Vec2<double>(reference.head<2>()), radius)
                          : classify(view, Vec3<double>(reference), radius);
}

TypeTwo class_of(const Lines& lines, double radius = 1) {
  Rows unit = lines.rows;
  for (Eigen::Index i = 0; i < unit.rows(); ++i) {
    unit.row(i) /= unit.row(i).head(lines.dimension()).norm();
    unit.row(i).tail(lines.moments()) /= radius;
  }
  return class_of(unit, lines.reference, radius);
}

/// Lengths to 1e-9 of `size`.
void expect_known(const TypeTwo& found, const Lines& known, double size = 1) {
  EXPECT_EQ(to_string(found.kind), to_string(known.kind)) << known.name;
  EXPECT_EQ(found.rank, known.rank) << known.name;
  EXPECT_EQ(found.singular, known.rank < known.rows.cols()) << known.name;
  EXPECT_EQ(found.point.has_value(), known.point.has_value()) << known.name;
  EXPECT_EQ(found.screw.has_value(), known.rank == 5) << known.name;
  if (known.point && found.point) {
    EXPECT_LT((*found.point - *known.point).norm(), 1e-9 * size) << known.name;
  }
  if (!known.screw || !found.screw) return;
  const Screw &is = *found.screw, &should = *known.screw;
  EXPECT_LT(is.direction.cross(should.direction).norm(), 1e-9) << known.name;
  EXPECT_NEAR(is.direction.norm(), 1, 1e-15);
  if (should.pitch == infinity) {
    EXPECT_EQ(is.pitch, infinity) << known.name;
    return;
  }
  EXPECT_NEAR(is.pitch, should.pitch, 1e-9 * size) << known.name;
  if (should.point.allFinite()) {
    EXPECT_LT((is.point - should.point).cross(should.direction).norm(), 1e-9 * size) << known.name;
  }
  EXPECT_LT(std::abs((is.point - known.reference).dot(is.direction)), 1e-9 * size) << "not the nearest";
}

TEST(LineClass, IsThatOfTheReferenceAndOfTheDefinition) {  // TDPCR 5.1 and constructions
  for (const Lines& lines : all_lines()) expect_known(class_of(lines), lines);
}

TEST(LineClass, EveryClassHasACase) {
  std::vector<LineClass> seen;
  for (const Lines& lines : all_lines()) seen.push_back(lines.kind);
  for (int k = static_cast<int>(LineClass::concurrent); k <= static_cast<int>(LineClass::special_complex);
       ++k)
    EXPECT_NE(std::find(seen.begin(), seen.end(), static_cast<LineClass>(k)), seen.end())
        << to_string(static_cast<LineClass>(k));
  EXPECT_EQ(to_string(static_cast<LineClass>(99)), "unknown");
}

/// The same lines of a robot that is turned, moved and scaled, about another point of its platform.
Lines moved(const Lines& lines, Random& random, double scale) {
  const Eigen::Index d = lines.dimension();
  const V3 lever = d == 2 ? random.level() : random.vector(),
           shift = scale * (d == 2 ? random.level() : random.vector()),
           axis = d == 2 ? V3::UnitZ() : random.vector().normalized();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(pi * random(), axis).toRotationMatrix();
  const auto place = [&](const V3& p) { return V3(turn * (scale * p) + shift); };
  Lines result = lines;
  result.reference = place(lines.reference + lever);
  for (Eigen::Index i = 0; i < lines.rows.rows(); ++i) {
    V3 f = V3::Zero(), m = V3::Zero();
    f.head(d) = lines.rows.row(i).head(d).transpose();
    m.tail(lines.moments()) = lines.rows.row(i).tail(lines.moments()).transpose();
    m = turn * (scale * (m - lever.cross(f)));
    f = turn * f;
    result.rows.row(i) << f.head(d).transpose(), m.tail(lines.moments()).transpose();
  }
  if (lines.point) result.point = place(*lines.point);
  if (lines.screw)
    result.screw =
        Screw{lines.screw->pitch * scale, place(lines.screw->point), turn * lines.screw->direction};
  return result;
}

TEST(LineClass, MovesTurnsAndScalesWithTheRobot) {
  Random random;
  for (const Lines& lines : all_lines())
    for (const double scale : {1e-3, 1.0, 1e3})
      for (int i = 0; i < 50; ++i) {
        const Lines there = moved(lines, random, scale);
        expect_known(class_of(there, scale * std::exp(random())), there, 10 * scale);
      }
}

TEST(LineClass, StaysWithLinesThatAreOffByLessThanTheTolerance) {
  Random random;
  for (const Lines& lines : all_lines())
    for (int i = 0; i < 50; ++i) {
      Lines off = lines;
      for (double& number : off.rows.reshaped()) number += 1e-12 * random();
      const TypeTwo type = class_of(off);
      EXPECT_EQ(to_string(type.kind), to_string(lines.kind)) << lines.name;
      EXPECT_EQ(type.rank, lines.rank) << lines.name;
    }
}

TEST(Screw, LeavesEveryLineAtRest) {
  for (const Lines& lines : all_lines()) {
    const TypeTwo type = class_of(lines);
    if (!type.screw || type.screw->pitch == infinity) continue;
    const auto& [pitch, point, direction] = *type.screw;
    Eigen::Matrix<double, 6, 1> twist;
    twist << pitch * direction + (point - lines.reference).cross(direction), direction;
    const Eigen::VectorXd along = lines.rows * twist;
    EXPECT_LT(along.norm(), 1e-13 * lines.rows.norm() * twist.norm()) << lines.name;
  }
}

TEST(Screw, PointsUpwards) {
  for (const V3& up : {V3(-1, -2, 3), V3(-1, 2, 0), V3(1, 0, 0)})
    for (const double sign : {1.0, -1.0}) {
      Random random;
      const auto meeting = [&](int) { return Line{sign * random() * up, random.vector()}; };
      const Lines lines = in_space("meet a line", LineClass::special_complex, 5, meeting);
      EXPECT_LT((class_of(lines).screw.value().direction - up.normalized()).norm(), 1e-12);
    }
}

TEST(LineClass, FadesWithTheToleranceNotWithTheUnit) {
  const auto lifted = [](double by, double size) {  // three concurrent lines of the plane, one moved aside
    Lines lines{.name = "", .rows = Rows(3, 3)};
    lines.rows << 1, 0, 0, 0, 1, 0, 1, 1, by * size;
    return class_of(lines, size);
  };
  for (const double size : {1e-3, 1.0, 1e3}) {
    EXPECT_EQ(lifted(1e-8, size).kind, LineClass::regular);
    EXPECT_EQ(lifted(1e-12, size).kind, LineClass::concurrent);
    // unit rows: det = 1e-8/√2, σ₁ = √2, σ₂ = 1
    EXPECT_NEAR(lifted(1e-8, size).condition * 1e-8, 2 * std::sqrt(2.0), 1e-6);
    EXPECT_NEAR(lifted(1e-12, size).condition * 1e-12, 2 * std::sqrt(2.0), 1e-6);
    EXPECT_TRUE(std::isnan(lifted(0, size).condition));
  }
}

TEST(LineClass, OfWhatAreNoLinesIsSaidHonestly) {
  const std::array<double, 36> zeros{};
  for (const Eigen::Index rows : {0, 1, 6}) {
    const TypeTwo planar = classify({zeros.data(), rows, 3}, Vec2<double>(0, 0), 1);
    const TypeTwo spatial = classify({zeros.data(), rows, 6}, Vec3<double>(0, 0, 0), 1);
    for (const TypeTwo& type : {planar, spatial}) {
      EXPECT_TRUE(type.singular);
      EXPECT_EQ(type.rank, 0);
      EXPECT_EQ(type.kind, LineClass::none);
      EXPECT_TRUE(std::isnan(type.condition));
      EXPECT_FALSE(type.point || type.screw);
    }
  }
  for (const double bad : {nan, infinity}) {
    std::array<double, 36> rows = zeros;
    for (std::size_t i = 0; i < 36; i += 7) rows[i] = 1;
    rows[5] = bad;
    EXPECT_EQ(classify({rows.data(), 3, 3}, Vec2<double>(0, 0), 1).kind, LineClass::undefined);
    const TypeTwo type = classify({rows.data(), 6, 6}, Vec3<double>(0, 0, 0), 1);
    EXPECT_EQ(type.kind, LineClass::undefined);
    EXPECT_TRUE(type.singular);
    EXPECT_FALSE(type.point || type.screw);
  }
}

TEST(LineClass, CountsALegWithoutALineAsAbsent) {
  for (const Lines& lines : all_lines()) {
    Rows unit = Rows::Zero(lines.rows.rows() + 1, lines.rows.cols());
    for (Eigen::Index i = 0; i < lines.rows.rows(); ++i)
      unit.row(i) = lines.rows.row(i) / lines.rows.row(i).head(lines.dimension()).norm();
    expect_known(class_of(unit, lines.reference, 1), lines);
  }
}

}  // namespace lines_test
}  // namespace sinew::test
