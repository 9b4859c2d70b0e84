/// @file line_cases.hpp
/// Sets of lines whose class is known: by construction, and those of an independent implementation.
#pragma once
#include <cmath>
#include <random>

#include "reference_file.hpp"
#include "sinew/analysis/velocity.hpp"

namespace sinew::test {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using V3 = Eigen::Vector3d;

/// Lines about a reference point and what is known of them, in one base frame.
struct Lines {
  std::string name;
  Rows rows;  ///< as a robot has them: of any length, moments in metres
  V3 reference = V3::Zero();
  LineClass kind = LineClass::regular;
  int rank = 0;
  std::optional<V3> point = {};
  std::optional<Screw> screw = {};  ///< with any point of its axis, NaN if that is not known

  Eigen::Index dimension() const { return rows.cols() == 3 ? 2 : 3; }
  Eigen::Index moments() const { return rows.cols() - dimension(); }
};

struct Random {
  std::mt19937 engine{3};
  double operator()() { return std::uniform_real_distribution(-1.0, 1.0)(engine); }
  V3 vector() { return {(*this)(), (*this)(), (*this)()}; }
  V3 level() { return {(*this)(), (*this)(), 0}; }
};

/// A line of space.
struct Line {
  V3 point, direction;
};

/// `count` lines of space, each by a call with its number.
template <class F>
Lines in_space(std::string name, LineClass kind, int rank, const F& line, Eigen::Index count = 6) {
  Lines result{.name = std::move(name),
               .rows = Rows(count, 6),
               .reference = {0.3, -0.2, 0.5},
               .kind = kind,
               .rank = rank};
  for (Eigen::Index i = 0; i < count; ++i) {
    const Line at = line(static_cast<int>(i));
    result.rows.row(i) << at.direction.transpose(),
        (at.point - result.reference).cross(at.direction).transpose();
  }
  return result;
}

inline const V3 x = V3::UnitX(), y = V3::UnitY(), z = V3::UnitZ(), origin = V3::Zero(),
                centre(0.4, 0.1, -0.3);

/// Unit vectors of the plane of a and b.
inline V3 fan(const V3& a, const V3& b, int i) { return a * std::cos(i) + b * std::sin(i); }

inline std::vector<Lines> lines_of_rank_one_and_two(Random& random) {
  using enum LineClass;
  const auto any = [&](int) { return Line{random.vector(), random.vector()}; };
  const auto one = [](int i) { return Line{centre + i * (x + y), (i - 7.5) * (x + y)}; };
  const auto in_turn = [](int i) { return i % 2 ? Line{origin, x} : Line{z, y}; };
  const auto pencil = [](int i) { return Line{centre, fan(x, y, i)}; };
  const auto rake = [](int i) { return Line{centre + i * y, x}; };
  return {in_space("one line, by six of its points", single_line, 1, one),
          in_space("one leg", single_line, 1, any, 1),
          in_space("two legs", skew_pair, 2, any, 2),
          in_space("two skew lines in turn", skew_pair, 2, in_turn),
          in_space("pencil", planar_pencil, 2, pencil),
          in_space("two legs that meet", planar_pencil, 2, pencil, 2),
          in_space("parallel lines of a plane", planar_pencil, 2, rake)};
}

inline std::vector<Lines> lines_of_rank_three(Random& random) {
  using enum LineClass;
  const auto any = [&](int) { return Line{random.vector(), random.vector()}; };
  const auto hyperboloid = [](int i) { return Line{fan(x, y, i), fan(y, -x, i) + 0.7 * z}; };
  const auto saddle = [](int i) { return Line{i * x, y + i * z}; };  // z = xy
  const auto pencils = [](int i) { return i < 3 ? Line{origin, fan(x, y, i)} : Line{x, fan(x, z, i)}; };
  const auto meeting = [&](int) { return Line{centre, random.vector()}; };
  const auto upright = [&](int) { return Line{random.vector(), z}; };
  const auto level = [&](int) { return Line{random.level(), random.level()}; };
  Lines point = in_space("through one point", bundle, 3, meeting);
  point.point = centre;
  return {in_space("three skew lines", regulus, 3, any, 3),
          in_space("hyperboloid", regulus, 3, hyperboloid),
          in_space("saddle", regulus, 3, saddle),
          in_space("pencils in two planes, centres on their common line", two_pencils, 3, pencils),
          in_space("parallel lines", bundle, 3, upright),
          in_space("lines of a plane", plane_of_lines, 3, level),
          point};
}

inline std::vector<Lines> lines_of_rank_four(Random& random) {
  using enum LineClass;
  const auto twisted = [&](int) {  // on hyperboloids about z, all of one hand
    const V3 p = random.level();
    return Line{p, z.cross(p) + z};
  };
  const auto across = [&](int) {  // meets the z axis and a line along y
    const V3 p = random() * z, q = x + random() * y;
    return Line{p, q - p};
  };
  const auto rungs = [&](int) { return Line{random() * z, random.level()}; };
  const auto parabolic = [&](int) {  // pencils along the z axis, whose plane turns with the height
    const double height = random();
    return Line{height * z, V3(height, 1, random())};
  };
  const auto level = [&] { return Line{random.level(), random.level()}; };
  const auto plane_and_point = [&](int i) { return i < 3 ? level() : Line{0.3 * x, random.vector()}; };
  const auto plane_and_far_point = [&](int i) { return i < 3 ? level() : Line{random.vector(), x}; };
  return {in_space("twisted", elliptic_congruence, 4, twisted),
          in_space("meet two skew lines", hyperbolic_congruence, 4, across),
          in_space("meet a line, parallel to a plane", hyperbolic_congruence, 4, rungs),
          in_space("parabolic", parabolic_congruence, 4, parabolic),
          in_space("in a plane or through its point", degenerate_congruence, 4, plane_and_point),
          in_space("in a plane or parallel in it", degenerate_congruence, 4, plane_and_far_point)};
}

inline std::vector<Lines> lines_of_rank_five_and_six(Random& random) {
  using enum LineClass;
  const auto any = [&](int) { return Line{random.vector(), random.vector()}; };
  const auto meeting = [&](int) { return Line{centre + random() * (x + z), random.vector()}; };
  const auto level = [&](int) { return Line{random.vector(), random.level()}; };
  std::vector<Lines> cases{in_space("six legs", regular, 6, any), in_space("eight legs", regular, 6, any, 8),
                           in_space("five legs", general_complex, 5, any, 5),
                           in_space("meet a line", special_complex, 5, meeting),
                           in_space("parallel to a plane", special_complex, 5, level)};
  cases[3].screw = Screw{0, centre, (x + z).normalized()};
  cases[4].screw = Screw{std::numeric_limits<double>::infinity(), origin, z};
  for (const double pitch : {0.3, -2.0}) {
    cases.push_back(in_space("normals of helices", general_complex, 5, [&](int) {
      const V3 arm = random.vector(), along = pitch * z + z.cross(arm);
      return Line{centre + arm, along.cross(random.vector())};
    }));
    cases.back().screw = Screw{pitch, centre, z};
  }
  return cases;
}

inline Lines in_plane(std::string name, LineClass kind, int rank, std::vector<V3> rows,
                      std::optional<V3> point = {}) {
  Lines result{
      .name = std::move(name), .rows = Rows(rows.size(), 3), .kind = kind, .rank = rank, .point = point};
  for (std::size_t i = 0; i < rows.size(); ++i) result.rows.row(static_cast<Eigen::Index>(i)) = rows[i];
  return result;
}

inline std::vector<Lines> planar_lines() {
  using enum LineClass;
  const V3 a(1, 0, -2), b(0, 1, 3), c(1, 1, 1), d(1, -1, -5), meeting(3, 2, 0);
  return {in_plane("triangle", regular, 3, {a, b, c + z}),
          in_plane("four legs", regular, 3, {a, b, c + z, d}),
          in_plane("four legs that meet", concurrent, 2, {a, b, c, d}, meeting),
          in_plane("two legs", concurrent, 2, {a, b}, meeting),
          in_plane("parallel", parallel, 2, {c, -2 * c + z, 0.5 * c + 3 * z}),
          in_plane("two parallel legs", parallel, 2, {a, a + z}),
          in_plane("one line", coincident, 1, {c, -2 * c, 0.5 * c}),
          in_plane("one leg", coincident, 1, {c})};
}

inline LineClass named(const std::string& text) {
  for (int k = 0; k <= static_cast<int>(LineClass::special_complex); ++k)
    if (to_string(static_cast<LineClass>(k)) == text) return static_cast<LineClass>(k);
  throw std::runtime_error(text + " is no class of lines");
}

inline V3 padded(const nlohmann::json& list) {
  V3 result = V3::Zero();
  for (std::size_t i = 0; i < list.size(); ++i) result[static_cast<Eigen::Index>(i)] = list[i];
  return result;
}

/// The cases of an independent implementation, which does not say where the axes of its screws are.
inline std::vector<Lines> reference_lines() {
  std::vector<Lines> cases;
  const nlohmann::json& all = reference_file("data/tdpcr/singular.json");
  for (const auto& [list, matrix] :
       {std::pair("planar_classification", "J"), std::pair("spatial_classification", "lines")})
    for (const nlohmann::json& given : all[list]) {
      const auto rows = given[matrix].get<std::vector<std::vector<double>>>();
      Lines lines{.name = given["name"], .rows = Rows(rows.size(), rows[0].size())};
      for (std::size_t i = 0; i < rows.size(); ++i)
        lines.rows.row(static_cast<Eigen::Index>(i)) =
            Eigen::Map<const Eigen::RowVectorXd>(rows[i].data(), lines.rows.cols());
      lines.kind = named(given["class"]);
      lines.rank = given["rank"];
      if (given.contains("p")) lines.reference = padded(given["p"]);
      if (given.contains("pose")) lines.reference.head<2>() = padded(given["pose"]).head<2>();
      if (given.contains("point_rel_Oprime"))
        lines.point = lines.reference + padded(given["point_rel_Oprime"]);
      cases.push_back(lines);
      if (!given.contains("pitch")) continue;
      const V3 unknown = V3::Constant(std::numeric_limits<double>::quiet_NaN());
      cases.back().screw = Screw{given["pitch"], unknown, padded(given["axis_dir"])};
    }
  return cases;
}

inline std::vector<Lines> all_lines() {
  Random random;
  std::vector<Lines> all;
  for (const auto& some :
       {reference_lines(), planar_lines(), lines_of_rank_one_and_two(random), lines_of_rank_three(random),
        lines_of_rank_four(random), lines_of_rank_five_and_six(random)})
    all.insert(all.end(), some.begin(), some.end());
  return all;
}

}  // namespace sinew::test
