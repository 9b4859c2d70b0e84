#include "sinew/tendon/diagram.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <random>

#include "math/polygon.hpp"
#include "reference_file.hpp"
#include "sinew/kernel/direction.h"
#include "thorough.hpp"

namespace sinew {
namespace diagram_test {

using Json = nlohmann::json;
using Point = Vec2<double>;
using Kind = Envelope::Kind;

constexpr double pi = std::numbers::pi;
constexpr double mm = 1e-3, deg = pi / 180;

// The robot of [LSK] Table 2.
constexpr int joints = 8;
constexpr double joint_length = 2.375 * mm, radius = 2.45 * mm;
const auto twin_pivot =
    kernel::make_section<double>(kernel::Backbone::twin_pivot, joints, joint_length, radius);
const auto neutral = kernel::make_section<double>(kernel::Backbone::neutral, joints, joint_length, radius);

std::vector<kernel::Direction<double>> spread(int count, double first) {
  std::vector<kernel::Direction<double>> at;
  for (int i = 0; i < count; ++i)
    at.push_back({std::cos(first + 2 * pi * i / count), std::sin(first + 2 * pi * i / count)});
  return at;
}

/// A question that owns what it points to.
struct Asked {
  Asked(const kernel::Section<double>& section, int count, double first, const Envelope& envelope)
      : at(spread(count, first)),
        changes(std::size_t(count)) {
    question.section = section;
    question.envelope = envelope;
    question.tolerance = 1e-9;
  }

  Asked& taut(const Point& x, double slack = 0) {
    for (std::size_t i = 0; i < changes.size(); ++i) changes[i] = slack - asked_of(i, x);
    return *this;
  }

  /// −Δl a bend asks for, as the paper has it: joint by joint, with sines, and not for straight ones.
  double asked_of(std::size_t i, const Point& x) const {
    const double c = at[i].cosine, s = at[i].sine;
    if (question.model == kernel::Model::linear) return question.section.gain * (c * x[0] + s * x[1]);
    const auto joint = [&](double angle, double share) {
      return angle == 0 ? 0
                        : joint_length - 2 * std::sin(angle / 2) * (joint_length / angle - radius * share);
    };
    if (question.section.backbone == kernel::Backbone::twin_pivot)
      return joints / 2 * (joint(x[0], c) + joint(x[1], s));
    return x.norm() > 0 ? joints * joint(x.norm() / joints, (c * x[0] + s * x[1]) / x.norm()) : 0;
  }
  double slack(std::size_t i, const Point& x) const { return changes[i] + asked_of(i, x); }
  double min_slack(const Point& x) const {
    double least = 1e9;
    for (std::size_t i = 0; i < changes.size(); ++i) least = std::min(least, slack(i, x));
    return least;
  }
  bool allows(const Point& x, double room = 0) const {
    const double limit = question.envelope.limit;
    if (question.envelope.kind == Kind::square)
      return std::max(std::abs(x[0]), std::abs(x[1])) <= limit + room;
    if (question.envelope.kind == Kind::disc) return x.norm() <= limit + room;
    return std::all_of(at.begin(), at.end(), [&](const auto& u) {
      return std::abs(u.cosine * x[0] + u.sine * x[1]) <= limit / question.section.gain + room;
    });
  }

  SectionDiagram answer() {
    question.tendons = {at, changes};
    return section_diagram(question);
  }

  std::vector<kernel::Direction<double>> at;
  std::vector<double> changes;
  DiagramQuestion question{};
};

double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

double gap(const Polygon& a, const Polygon& b) {
  double most = 0;
  for (const auto& [from, to] : {std::pair(&a, &b), std::pair(&b, &a)})
    for (const Point& x : *from) {
      double nearest = 1e9;
      for (const Point& y : *to) nearest = std::min(nearest, (x - y).norm());
      most = std::max(most, nearest);
    }
  return most;
}

// ---- the examples of an independent implementation

Point point_of(const Json& json) { return {json[0].get<double>(), json[1].get<double>()}; }
Polygon polygon_of(const Json& json) {
  Polygon polygon;
  for (const Json& x : json) polygon.push_back(point_of(x));
  return polygon;
}

Asked example(const Json& json) {
  const std::string kind = json["envelope"][0];
  const double limit = json["envelope"][1];
  const Envelope envelope = kind == "square" ? Envelope{Kind::square, limit}
                            : kind == "disc" ? Envelope{Kind::disc, limit}
                                             : Envelope{Kind::actuator, limit * mm};
  const auto deltas = json["delta_rad"].get<std::vector<double>>();
  Asked asked(json["kind"] == "tp" ? twin_pivot : neutral, int(deltas.size()), deltas[0], envelope);
  for (std::size_t i = 0; i < deltas.size(); ++i) asked.changes[i] = json["dl_mm"][i].get<double>() * mm;
  asked.question.tolerance = json["eps_mm"].get<double>() * mm;
  return asked;
}

std::string name(TendonConsistency agree) {
  const std::array names{"exact", "indeterminate", "inconsistent", "unreachable"};
  return names[std::size_t(agree)];
}

TEST(SectionDiagram, AnIndependentImplementationAgrees) {  // [LSK] sections 4.1, 4.2
  const Json& file = test::reference_file("data/lsk/polygons.json");
  EXPECT_EQ(file["examples"].size(), 11u);
  for (const Json& json : file["examples"]) {
    SCOPED_TRACE(json["name"].get<std::string>());
    Asked asked = example(json);
    const SectionDiagram found = asked.answer();
    ASSERT_TRUE(found.report.ok());
    EXPECT_EQ(name(found.agree), json["class"]);
    EXPECT_EQ(found.partial, json["partial"]);
    EXPECT_EQ(found.point_is_allowed, json["ls_inside_envelope"]);
    const double bends = 1e-14 * (1 + found.point.norm()), lengths = 2e-14 * mm;
    EXPECT_LT((found.point - point_of(json["ls_solution"])).norm(), bends);
    for (std::size_t i = 0; i < asked.at.size(); ++i)
      EXPECT_NEAR(found.slack[i], json["slack_at_ls_mm"][i].get<double>() * mm, lengths);
    EXPECT_NEAR(found.margin, json["margin_mm"].get<double>() * mm, lengths);
    if (json["name"] != "tp4_partial_segment") {  // its whole segment has that margin
      EXPECT_LT((found.margin_point - point_of(json["margin_point"])).norm(), bends);
    }
    EXPECT_NEAR(asked.min_slack(found.margin_point), found.margin, lengths);
    EXPECT_NEAR(found.over_tension, json["least_over_tension_mm"].get<double>() * mm, lengths);
    EXPECT_NEAR(found.free_area, json["area_free"], 1e-12 * json["area_free"].get<double>());
    EXPECT_NEAR(found.area, json["area_envelope"], 1e-12 * json["area_envelope"].get<double>());
    if (const Polygon free = polygon_of(json["polygon_free"]); !free.empty()) {
      EXPECT_LT(gap(*found.free, free), 1e-14 + bends);
    }
    if (json["polygon_envelope"].is_null()) continue;
    if (const Polygon cut = polygon_of(json["polygon_envelope"]); !cut.empty()) {
      EXPECT_LT(gap(found.boundary, cut), 1e-14 + bends);
    }
  }
}

// ---- examples the notes give in words

TEST(SectionDiagram, UniformSlackIsATriangleAroundTheBend) {
  Asked asked(twin_pivot, 3, 24 * deg, {Kind::square, 24 * deg});
  const auto found = asked.taut({10 * deg, -5 * deg}, 0.1 * mm).answer();
  EXPECT_EQ(name(found.agree), "indeterminate");
  EXPECT_NEAR(found.area, 5.4104e-4, 5e-9);
  EXPECT_NEAR(found.margin / twin_pivot.gain / deg, 0.585, 5e-4);
}

TEST(SectionDiagram, UnevenSlackMovesTheBend) {
  Asked asked(twin_pivot, 3, 24 * deg, {Kind::square, 24 * deg});
  asked.taut({10 * deg, -5 * deg});
  asked.changes[0] += 0.05 * mm, asked.changes[1] += 0.3 * mm;
  const auto found = asked.answer();
  EXPECT_NEAR(found.point[0] / deg, 10.768, 5e-4);
  EXPECT_NEAR(found.point[1] / deg, -5.767, 6e-4);
  EXPECT_NEAR(found.margin, 0.35 * mm / 3, 1e-16);
}

TEST(SectionDiagram, TheEnvelopeCutsATriangleToAQuadrangle) {
  Asked asked(twin_pivot, 3, 24 * deg, {Kind::square, 24 * deg});
  const auto found = asked.taut({22 * deg, 22 * deg}, 0.4 * mm).answer();
  EXPECT_NEAR(found.free_area, std::sqrt(27.0) * (0.4 / 9.8) * (0.4 / 9.8), 1e-16);
  EXPECT_NEAR(found.area, 6.7446e-3, 5e-8);
  EXPECT_EQ(found.boundary.size(), 4u);
}

// ---- closed forms

struct Random {
  explicit Random(unsigned seed) : engine(seed) {}
  double operator()(double low, double high) { return uniform(engine, low, high); }
  std::mt19937 engine;
};

/// Anything a section may be asked: models, backbones, envelopes; about half with the least-squares point
/// allowed.
Asked any_question(Random& random, kernel::Model model, int count) {
  const bool twin = random(0, 1) < 0.5;
  const double size = twin ? 0.42 : 3.5;
  const int kind = int(random(0, 3));
  const auto& section = twin ? twin_pivot : neutral;
  const Envelope envelope = kind == 0   ? Envelope{Kind::square, size}
                            : kind == 1 ? Envelope{Kind::disc, size}
                                        : Envelope{Kind::actuator, size * section.gain};
  Asked asked(section, count, random(-pi, pi), envelope);
  asked.question.model = model;
  asked.taut({random(-1.5, 1.5) * size, random(-1.5, 1.5) * size}, random(-0.05, 0.3) * size * section.gain);
  for (double& change : asked.changes) change += random(-0.1, 0.1) * size * section.gain;
  return asked;
}

RC_GTEST_PROP(SectionDiagram, ThreeTendonsLeaveAnEquilateralTriangle, ()) {  // [LSK] section 4.1
  Random random(*rc::gen::arbitrary<unsigned>());
  Asked asked = any_question(random, kernel::Model::linear, 3);
  const auto found = asked.answer();
  double mean = 0;
  for (const double change : asked.changes) mean += change / 3;
  const double gain = asked.question.section.gain, inradius = mean / gain;
  for (const double slack : found.slack) RC_ASSERT(std::abs(slack - mean) < 1e-16);
  if (found.point_is_allowed) {
    RC_ASSERT(std::abs(found.margin - mean) < 1e-16);
    RC_ASSERT((found.margin_point - found.point).norm() == 0);
  } else {
    RC_ASSERT(found.margin <= mean + 1e-16);
  }
  RC_ASSERT(found.free->empty() == (mean < 0));
  if (mean < 0) return;
  RC_ASSERT(std::abs(found.free_area / (std::sqrt(27.0) * inradius * inradius) - 1) < 1e-13 / inradius);
  Polygon expected;
  for (const auto& u : asked.at) expected.push_back(found.point + 2 * inradius * Point(u.cosine, u.sine));
  RC_ASSERT(gap(*found.free, expected) < 1e-14);
}

RC_GTEST_PROP(SectionDiagram, FourTendonsLeaveARectangle, ()) {  // [LSK] section 4.1
  Random random(*rc::gen::arbitrary<unsigned>());
  Asked asked = any_question(random, kernel::Model::linear, 4);
  const auto found = asked.answer();
  const double gain = asked.question.section.gain;
  const double a = asked.changes[0] + asked.changes[2], b = asked.changes[1] + asked.changes[3];
  RC_ASSERT(found.free->empty() == (std::min(a, b) < 0));
  if (!found.free->empty())
    RC_ASSERT(std::abs(found.free_area - a * b / gain / gain) < 1e-14 * (1 + a * b / gain / gain));
  if (found.point_is_allowed) RC_ASSERT(std::abs(found.margin - std::min(a, b) / 2) < 1e-16);
  if (found.point_is_allowed)
    RC_ASSERT(std::abs(found.over_tension - std::max({0.0, -a / 2, -b / 2})) < 1e-16);
}

TEST(SectionDiagram, ARectangleWithoutWidthIsASegmentAndNotExact) {  // [LSK] section 4.1
  Asked asked(twin_pivot, 4, 24 * deg, {Kind::square, 24 * deg});
  asked.taut({10 * deg, -5 * deg});
  asked.changes[0] += 0.1 * mm, asked.changes[2] += 0.1 * mm;
  const auto segment = asked.answer();
  EXPECT_EQ(name(segment.agree), "indeterminate");
  EXPECT_TRUE(segment.partial);
  EXPECT_EQ(segment.area, 0);
  ASSERT_EQ(segment.boundary.size(), 2u);
  EXPECT_NEAR((segment.boundary[0] - segment.boundary[1]).norm(), 0.2 * mm / twin_pivot.gain, 1e-15);
  asked.changes[1] -= 0.02 * mm;  // too short together with its opposite, however slack the others are
  const auto negative = asked.answer();
  EXPECT_EQ(name(negative.agree), "inconsistent");
  EXPECT_NEAR(negative.over_tension, 0.01 * mm, 1e-17);
  EXPECT_TRUE(negative.free->empty());
  EXPECT_TRUE(negative.boundary.empty());
}

TEST(SectionDiagram, ToleranceDecidesNotArea) {
  Asked asked(neutral, 3, 0.3, {Kind::disc, 6.0});
  for (const double slack : {0.09 * mm, -0.09 * mm}) {
    asked.taut({1, 0.5}, slack);
    asked.question.tolerance = 0.1 * mm;
    EXPECT_EQ(name(asked.answer().agree), "exact");
    asked.question.tolerance = 0.08 * mm;
    EXPECT_EQ(name(asked.answer().agree), slack > 0 ? "indeterminate" : "inconsistent");
  }
  asked.taut({5, 5});
  asked.question.tolerance = 1e-9;
  const auto far = asked.answer();
  EXPECT_EQ(name(far.agree), "unreachable");
  EXPECT_FALSE(far.point_is_allowed);
  ASSERT_EQ(far.free->size(), 1u);
  EXPECT_TRUE(far.boundary.empty());
}

// ---- margin and area against plain search

/// On the way to x as far as allowed.
Point pulled_in(const Asked& asked, const Point& x) {
  double low = 0, high = 1;
  if (asked.allows(x)) return x;
  for (int k = 0; k < 53; ++k) (asked.allows((low + high) / 2 * x) ? low : high) = (low + high) / 2;
  return low * x;
}

/// Best of a grid over the envelope and its rim, refined around its best point by coarser ones.
double searched_margin(const Asked& asked, double half, Point centre) {
  double best = -1e9;
  for (int level = 0; level < 60; ++level) {
    const Point from = centre;
    const int count = level == 0 ? 20 : 4;
    for (int i = -count; i <= count; ++i)
      for (int j = -count; j <= count; ++j) {
        const Point x = pulled_in(asked, from + half / count * Point(i, j));
        if (const double slack = asked.min_slack(x); slack > best) best = slack, centre = x;
      }
    half *= level == 0 ? 0.3 : 0.6;
  }
  return best;
}

TEST(SectionDiagram, NoAllowedBendHasMoreMargin) {
  Random random(6);
  for (const auto model : {kernel::Model::linear, kernel::Model::exact})
    for (int sample = 0; sample < test::count_of(12, 40); ++sample) {
      Asked asked = any_question(random, model, 3 + sample % 4);
      const auto found = asked.answer();
      ASSERT_TRUE(found.report.ok()) << found.report.message.view();
      EXPECT_TRUE(asked.allows(found.margin_point, 1e-13));
      EXPECT_NEAR(asked.min_slack(found.margin_point), found.margin, 1e-16);
      const bool twin = asked.question.section.backbone == kernel::Backbone::twin_pivot;
      const double searched = searched_margin(asked, twin ? 0.6 : 5, {0, 0});
      EXPECT_GE(found.margin, searched - 1e-16);
      EXPECT_LT(found.margin,
                searched + 1e-3 * asked.question.section.gain);  // the search may stop short at a kink
    }
}

/// Area of the free, allowed bends by counting columns: the set is cut by each line in intervals found by
/// bisection. Columns are spread twice: over all bends, and over those where the first ones found any.
double searched_area(const Asked& asked, double half) {
  constexpr int columns = 200, steps = 150;
  const double step = 2 * half / steps;
  const auto is_in = [&](double x, double y) { return asked.allows({x, y}) && asked.min_slack({x, y}) >= 0; };
  const auto length_at = [&](double x) {
    double length = 0;
    for (int j = 0; j < steps; ++j) {
      double y = -half + j * step, next = y + step;
      const bool low_in = is_in(x, y), high_in = is_in(x, next);
      if (low_in && high_in) length += step;
      if (low_in == high_in) continue;
      const double start = y, end = next;
      for (int k = 0; k < 30; ++k) (is_in(x, (y + next) / 2) == low_in ? y : next) = (y + next) / 2;
      length += low_in ? y - start : end - y;
    }
    return length;
  };
  double left = -half, right = half, area = 0;
  for (int round = 0; round < 2; ++round) {
    const double width = (right - left) / columns, start = left;
    std::vector<double> filled;
    area = 0;
    for (int i = 0; i < columns; ++i) {
      const double x = start + (i + 0.5) * width, length = length_at(x);
      area += length * width;
      if (length > 0) filled.push_back(x);
    }
    if (filled.empty()) break;
    left = filled.front() - width;
    right = filled.back() + width;
  }
  return area;
}

TEST(SectionDiagram, AreaIsThatOfTheFreeAllowedBends) {
  Random random(7);
  for (const auto model : {kernel::Model::linear, kernel::Model::exact})
    for (int sample = 0; sample < test::count_of(6, 12); ++sample) {
      Asked asked = any_question(random, model, 3 + sample % 3);
      const auto found = asked.answer();
      ASSERT_TRUE(found.report.ok());
      const double half = asked.question.section.backbone == kernel::Backbone::twin_pivot ? 0.6 : 5;
      const double searched = searched_area(asked, half);
      EXPECT_NEAR(found.area, searched, 1e-4 * half * half);
      EXPECT_NEAR(area(found.boundary), found.area, 2e-3 * half);  // sampled to 1e-4 rad
      EXPECT_EQ(found.boundary.empty(), found.margin < 0);
      for (const Point& x : found.boundary) {
        EXPECT_TRUE(asked.allows(x, 1e-13));
        EXPECT_GT(asked.min_slack(x), -1e-15);
      }
    }
}

// ---- symmetry, earlier sections

RC_GTEST_PROP(SectionDiagram, TurningEverythingTurnsTheDiagram, ()) {
  Random random(*rc::gen::arbitrary<unsigned>());
  const double turn = random(-pi, pi);
  Asked asked(neutral, 3 + int(random(0, 3)), random(-pi, pi), {Kind::disc, random(1, 4)});
  asked.question.model = random(0, 1) < 0.5 ? kernel::Model::linear : kernel::Model::exact;
  asked.taut({random(-3, 3), random(-3, 3)}, random(-0.5, 1) * mm);
  Asked turned = asked;
  for (std::size_t i = 0; i < asked.at.size(); ++i)
    turned.at[i] = {std::cos(turn) * asked.at[i].cosine - std::sin(turn) * asked.at[i].sine,
                    std::sin(turn) * asked.at[i].cosine + std::cos(turn) * asked.at[i].sine};
  const auto a = asked.answer(), b = turned.answer();
  Eigen::Matrix2d R;
  R << std::cos(turn), -std::sin(turn), std::sin(turn), std::cos(turn);
  RC_ASSERT(a.agree == b.agree && a.partial == b.partial);
  RC_ASSERT((R * a.point - b.point).norm() < 1e-13);
  RC_ASSERT(std::abs(a.margin - b.margin) < 1e-16);
  RC_ASSERT(std::abs(a.area - b.area) < 1e-8 * (1e-6 + a.area));
  RC_ASSERT(std::abs(a.free_area - b.free_area) < 1e-12);
}

RC_GTEST_PROP(SectionDiagram, WhatEarlierSectionsAskIsTakenOff, ()) {
  Random random(*rc::gen::arbitrary<unsigned>());
  for (const auto model : {kernel::Model::linear, kernel::Model::exact}) {
    Asked asked = any_question(random, model, 3);
    Asked whole = asked;
    whole.question.earlier = {random(-1, 1) * mm, random(-1, 1) * mm, random(0, 0.2) * mm};
    for (std::size_t i = 0; i < asked.at.size(); ++i)
      whole.changes[i] += kernel::tendon_change(whole.question.earlier, whole.at[i]);
    const auto a = asked.answer(), b = whole.answer();
    RC_ASSERT((a.point - b.point).norm() < 1e-13);
    RC_ASSERT(std::abs(a.margin - b.margin) < 1e-16);
    RC_ASSERT(std::abs(a.area - b.area) < 1e-8 * (1e-6 + a.area));
  }
}

// ---- the exact model

RC_GTEST_PROP(SectionDiagram, ExactLengthsAreExactInTheExactModelOnly, ()) {
  Random random(*rc::gen::arbitrary<unsigned>());
  Asked asked(random(0, 1) < 0.5 ? twin_pivot : neutral, 3 + int(random(0, 3)), random(-pi, pi),
              {Kind::square, 0.42});
  asked.question.model = kernel::Model::exact;
  const Point x(random(-0.4, 0.4), random(-0.4, 0.4));
  const auto found = asked.taut(x).answer();
  RC_ASSERT(name(found.agree) == "exact");
  RC_ASSERT((found.point - x).norm() < 1e-13);
  RC_ASSERT(std::abs(found.margin) < 1e-16);
  RC_ASSERT(found.area < 1e-20);
}

TEST(SectionDiagram, ExactLengthsSeemOverTensionedInTheLinearModelAndLinearOnesSlackInTheExact) {
  Asked asked(twin_pivot, 3, 24 * deg, {Kind::square, 24 * deg});
  asked.question.model = kernel::Model::exact;
  asked.taut({20 * deg, -20 * deg});
  asked.question.model = kernel::Model::linear;
  EXPECT_EQ(name(asked.answer().agree), "inconsistent");
  asked.taut({20 * deg, -20 * deg});
  asked.question.model = kernel::Model::exact;
  const auto slack = asked.answer();
  EXPECT_EQ(name(slack.agree), "indeterminate");
  for (const double value : slack.slack) EXPECT_GT(value, 0);
}

TEST(SectionDiagram,
     AtTheCornerOfTable2LinearLengthsLeaveTheAngleOfTheNotes) {  // 2.10 deg a joint at (24, 24) deg
  Asked asked(twin_pivot, 3, 24 * deg, {Kind::square, 60 * deg});
  asked.taut({24 * deg, 24 * deg});
  asked.question.model = kernel::Model::exact;
  const auto found = asked.answer();
  double farthest = 0;
  for (const Point& x : found.boundary) farthest = std::max(farthest, (x - Point(24 * deg, 24 * deg)).norm());
  EXPECT_NEAR(farthest / deg, 2.0986163480407423, 1e-9);
  asked.taut({24 * deg, 24 * deg}, 0);
}

TEST(SectionDiagram, SmallBendsAreThoseOfTheLinearModel) {
  for (const double size : {1e-2, 1e-3, 1e-4}) {
    Asked asked(twin_pivot, 3, 24 * deg, {Kind::square, 3 * size});
    asked.taut({2 * size, -size}, size * twin_pivot.gain);
    const auto linear = asked.answer();
    asked.question.model = kernel::Model::exact;
    const auto exact = asked.answer();
    EXPECT_LT((linear.point - exact.point).norm(), size * size);
    EXPECT_NEAR(linear.margin, exact.margin, size * size * twin_pivot.length);
    EXPECT_NEAR(linear.area, exact.area, 2 * size * size * size);
  }
}

TEST(SectionDiagram, FrontiersHaveNeitherSlackNorStretch) {
  Random random(8);
  std::size_t points = 0;
  for (int sample = 0; sample < 30; ++sample) {
    Asked asked = any_question(random, kernel::Model::exact, 3 + sample % 2);
    const auto exact = asked.answer();
    ASSERT_EQ(exact.curves.size(), asked.at.size());
    for (std::size_t i = 0; i < asked.at.size(); ++i) {
      points += exact.curves[i].size();
      for (const Point& x : exact.curves[i]) EXPECT_LT(std::abs(asked.slack(i, x)), 1e-15);
    }
    asked.question.model = kernel::Model::linear;
    const auto linear = asked.answer();
    for (std::size_t i = 0; i < asked.at.size(); ++i) {
      const HalfPlane& h = linear.frontiers[i];
      EXPECT_LT(std::abs(asked.slack(i, h.offset * h.normal + 0.3 * perp(h.normal))), 1e-16);
    }
  }
  EXPECT_GT(points, 3000u);
}

TEST(SectionDiagram, EachCornerOfACurvedSetIsFound) {  // two constraints hold there
  Asked asked(neutral, 4, 0.4, {Kind::disc, 3});
  asked.question.model = kernel::Model::exact;
  const auto found = asked.taut({1, 2}, 1.5 * mm).answer();
  int corners = 0;
  for (const Point& x : found.boundary) {
    int on = std::abs(x.norm() - 3) < 1e-12;
    for (std::size_t i = 0; i < 4; ++i) on += std::abs(asked.slack(i, x)) < 1e-14;
    corners += on > 1;
  }
  EXPECT_GE(corners, 3);
}

/// Area of a strip along tendon 0 through a bend, by its width at even steps.
double searched_strip(const Asked& asked, const Point& through) {
  constexpr int steps = 10000;
  constexpr double half = 0.05;
  const Point along(asked.at[0].cosine, asked.at[0].sine), across(asked.at[1].cosine, asked.at[1].sine);
  double area = 0;
  for (int k = 0; k < steps; ++k) {
    const Point start = through + half * (2 * (k + 0.5) / steps - 1) * along;
    const auto room = [&](double b) { return asked.min_slack(start + b * across); };
    double low = -0.02, high = 0.02;  // the middle of the strip: tendons 1 and 3 alike
    for (int n = 0; n < 60; ++n) {
      const double middle = (low + high) / 2;
      (asked.slack(1, start + middle * across) < asked.slack(3, start + middle * across) ? low : high) =
          middle;
    }
    if (room(low) < 0) continue;
    for (const double sign : {-1.0, 1.0}) {
      double in = 0, out = 0.1;
      for (int n = 0; n < 70; ++n) (room(low + sign * (in + out) / 2) >= 0 ? in : out) = (in + out) / 2;
      area += in * 2 * half / steps;
    }
  }
  return area;
}

TEST(SectionDiagram, AThinCurvedStripIsFollowedToItsEnds) {
  for (const double width : {1e-1, 1e-3, 1e-6, 1e-9}) {
    Asked asked(twin_pivot, 4, 24 * deg, {Kind::square, 24 * deg});
    asked.question.model = kernel::Model::exact;
    asked.taut({10 * deg, -5 * deg});
    for (const std::size_t i : {0u, 2u}) asked.changes[i] += 0.3 * mm;
    for (const std::size_t i : {1u, 3u}) asked.changes[i] += width * 0.1 * mm;
    const auto found = asked.answer();
    ASSERT_TRUE(found.report.ok());
    EXPECT_NEAR(found.area, searched_strip(asked, {10 * deg, -5 * deg}), 1e-3 * found.area) << width;
  }
}

TEST(SectionDiagram,
     ASetInPartsIsNotPassedOffAsOne) {  // so slender that what bending takes off its length rules
  const auto slender = kernel::make_section<double>(kernel::Backbone::twin_pivot, joints, 0.2, 1e-3);
  Asked asked(slender, 4, 0.1, {Kind::square, 1});
  asked.question.model = kernel::Model::exact;
  for (double& change : asked.changes) change = -20 * mm;
  const auto found = asked.answer();
  EXPECT_EQ(found.report.status, Status::stalled);
  EXPECT_FALSE(found.report.message.view().empty());
  EXPECT_GT(found.margin, 0);
  EXPECT_NEAR(std::abs(found.margin_point[0]), 1, 1e-15);
  EXPECT_NEAR(std::abs(found.margin_point[1]), 1, 1e-15);
}

// ---- sections after sections that are not exact

TEST(SectionOutline, IsWhereSomeBendsOfBothAgreeWithAllTendons) {
  Random random(9);
  for (int sample = 0; sample < test::count_of(8, 20); ++sample) {
    Asked own(twin_pivot, 3 + sample % 2, 48 * deg, {sample % 3 == 0 ? Kind::disc : Kind::square, 24 * deg});
    Asked previous(twin_pivot, 3, 24 * deg, own.question.envelope);
    const Point before(random(-0.1, 0.1), random(-0.1, 0.1)), x(random(-0.4, 0.4), random(-0.4, 0.4));
    previous.taut(before, random(0.05, 0.5) * mm);
    own.taut(before + x, random(0.05, 0.5) * mm);
    own.question.tendons = {own.at, own.changes};
    const auto outline = section_outline(own.question, {previous.at, previous.changes});
    ASSERT_TRUE(outline.report.ok());
    const Polygon theirs = *previous.answer().free;
    // A bend is in it if and only if the previous polygon, moved by it, meets the own one.
    for (int k = 0; k < 400; ++k) {
      const Point bend = x + Point(random(-0.15, 0.15), random(-0.15, 0.15));
      std::vector<HalfPlane> lines;
      for (const HalfPlane& h : previous.answer().frontiers) lines.push_back({h.normal, h.offset});
      for (const HalfPlane& h : own.answer().frontiers)
        lines.push_back({h.normal, h.offset - dot(h.normal, bend)});
      const bool meets = !intersection(lines)->empty() && own.allows(bend);
      bool within = outline.boundary.size() > 2;
      for (std::size_t n = 0; n < outline.boundary.size(); ++n) {
        const Point &a = outline.boundary[n], &b = outline.boundary[(n + 1) % outline.boundary.size()];
        const double side = cross(b - a, bend - a) / (b - a).norm();
        within = within && side >= 0;
        if (std::abs(side) < 1e-4) within = meets;  // on the sampled rim
      }
      EXPECT_EQ(meets, within);
    }
  }
}

TEST(SectionOutline, IsAHexagonOfThree_AndTheDiagramWhereThePreviousAreExact) {
  Asked own(twin_pivot, 3, 48 * deg, {Kind::square, 24 * deg}),
      previous(twin_pivot, 3, 24 * deg, own.question.envelope);
  own.taut({0.15, 0.05}, 0.2 * mm);
  own.question.tendons = {own.at, own.changes};
  previous.taut({0.1, -0.05}, 0.1 * mm);
  EXPECT_EQ(section_outline(own.question, {previous.at, previous.changes}).boundary.size(), 6u);
  previous.taut({0.1, -0.05});
  const auto outline = section_outline(own.question, {previous.at, previous.changes});
  own.question.earlier = kernel::linear_pull(twin_pivot, kernel::Bend<double>{0.1, -0.05});
  const auto alone = own.answer();
  EXPECT_LT(gap(outline.boundary, alone.boundary), 1e-15);
  EXPECT_NEAR(outline.area, alone.area, 1e-16);
}

TEST(SectionOutline, SaysWhyThereIsNone) {
  using Missing = SectionOutline::Missing;
  Asked own(twin_pivot, 3, 48 * deg, {Kind::square, 24 * deg}),
      previous(twin_pivot, 3, 24 * deg, own.question.envelope);
  const auto missing = [&](const Point& bend, double own_slack, double previous_slack) {
    own.taut(Point(0.1, -0.05) + bend, own_slack);
    previous.taut({0.1, -0.05}, previous_slack);
    own.question.tendons = {own.at, own.changes};
    const auto outline = section_outline(own.question, {previous.at, previous.changes});
    EXPECT_EQ(outline.boundary.empty(), outline.missing != Missing::none);
    return outline.missing;
  };
  EXPECT_EQ(missing({0.1, 0}, 0.1 * mm, 0.1 * mm), Missing::none);
  EXPECT_EQ(missing({0.1, 0}, 0, 0), Missing::none);
  EXPECT_EQ(missing({0.1, 0}, 0.1 * mm, -0.1 * mm), Missing::previous_over_tensioned);
  EXPECT_EQ(missing({0.1, 0}, -0.1 * mm, -0.1 * mm), Missing::previous_over_tensioned);
  EXPECT_EQ(missing({0.1, 0}, -0.1 * mm, 0.1 * mm), Missing::over_tensioned);
  EXPECT_EQ(missing({2, 0}, 0.1 * mm, 0.1 * mm), Missing::beyond_envelope);
}

// ---- what may go wrong

bool all_finite(const SectionDiagram& d) {
  bool finite =
      std::isfinite(d.margin + d.over_tension + d.area + d.free_area + d.point.sum() + d.margin_point.sum());
  for (const double slack : d.slack) finite = finite && std::isfinite(slack);
  for (const Point& x : d.boundary) finite = finite && x.allFinite();
  for (const Point& x : d.free.value_or(Polygon{})) finite = finite && x.allFinite();
  for (const Curve& curve : d.curves)
    for (const Point& x : curve) finite = finite && x.allFinite();
  return finite;
}

TEST(SectionDiagram, NumbersStayNumbers) {
  Random random(10);
  const auto any = [&] { return random(-1, 1) * std::pow(10.0, std::floor(random(-20, 6))); };
  for (int sample = 0; sample < 1500; ++sample) {
    const auto kind = std::array{Kind::square, Kind::disc, Kind::actuator}[std::size_t(sample % 3)];
    Asked asked(sample % 2 ? twin_pivot : neutral, 3 + sample % 5, random(-pi, pi), {kind, std::abs(any())});
    if (sample % 7 == 0) asked.question.envelope.limit = 0;
    asked.question.model = random(0, 1) < 0.3 ? kernel::Model::exact : kernel::Model::linear;
    if (sample % 4 == 0) {
      for (double& change : asked.changes) change = any();
    } else {
      asked.taut({random(-0.5, 0.5), random(-0.5, 0.5)}, sample % 4 == 1 ? 0 : any() * mm);
    }
    EXPECT_TRUE(all_finite(asked.answer()));
  }
}

TEST(SectionDiagram, WrongQuestionsAreRefused) {
  const auto status = [](const auto& spoil) {
    Asked asked(twin_pivot, 3, 0.2, {Kind::square, 0.4});
    asked.taut({0.1, 0.1});
    spoil(asked);
    const auto found = asked.answer();
    EXPECT_EQ(found.report.ok(), found.report.message.view().empty());
    return found.report.status;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(status([](Asked&) {}), Status::converged);
  for (const double bad : {nan, inf, -inf, 1e300}) {
    EXPECT_EQ(status([&](Asked& a) { a.changes[1] = bad; }), Status::left_domain);
    EXPECT_EQ(status([&](Asked& a) { a.question.earlier.common = bad; }), Status::left_domain);
    EXPECT_EQ(status([&](Asked& a) { a.question.envelope.limit = bad; }), Status::left_domain);
  }
  EXPECT_EQ(status([](Asked& a) { a.question.tolerance = -1e-9; }), Status::left_domain);
  EXPECT_EQ(status([](Asked& a) { a.changes.pop_back(); }), Status::left_domain);
  EXPECT_EQ(status([](Asked& a) { a.at.pop_back(), a.changes.pop_back(); }), Status::left_domain);
  EXPECT_EQ(status([](Asked& a) { a.at[0] = {1, 0}; }), Status::left_domain);  // not spread evenly
  EXPECT_EQ(status([](Asked& a) { a.question.section.gain = 0; }), Status::left_domain);
  EXPECT_EQ(status([](Asked& a) {
              a.question.envelope.limit = 4;
              a.question.model = kernel::Model::exact;
            }),
            Status::left_domain);
}

}  // namespace diagram_test
}  // namespace sinew
