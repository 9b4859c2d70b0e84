#include "tendon/state.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace sinew {
namespace state_test {

using Kind = Envelope::Kind;

constexpr double pi = std::numbers::pi, mm = 1e-3, deg = pi / 180;

struct Told {
  StateWords state;
  SectionDiagram diagram;
};

/// The words for a section of the robot of [LSK] Table 2, at a bend [rad] with slack [m] of each tendon.
Told told(const Vec2<double>& bend, std::vector<double> slack,
          const Envelope& envelope = {Kind::square, 24 * deg}) {
  DiagramQuestion question;
  question.section = kernel::make_section<double>(kernel::Backbone::twin_pivot, 8, 2.375 * mm, 2.45 * mm);
  std::vector<kernel::Direction<double>> at;
  for (std::size_t i = 0; i < slack.size(); ++i) {
    const double angle = 2 * pi * static_cast<double>(i) / static_cast<double>(slack.size());
    at.push_back({std::cos(angle), std::sin(angle)});
    slack[i] -= question.section.gain * (at[i].cosine * bend[0] + at[i].sine * bend[1]);
  }
  question.tendons = {at, slack};
  question.envelope = envelope;
  question.tolerance = 0.05 * mm;
  const SectionDiagram diagram = section_diagram(question);
  return {state_words(question, diagram), diagram};
}

TEST(StateWords, AreThoseOfTheOperator) {
  const StateWords exact = told({0.1, 0}, {0, 0, 0}).state;
  EXPECT_EQ(exact.word, "EXACT");
  EXPECT_EQ(exact.amount, 0);
  EXPECT_EQ(exact.advice, "");
  const StateWords slack = told({0.1, 0}, {0.5 * mm, 0.5 * mm, 0.5 * mm}).state;
  EXPECT_EQ(slack.word, "SLACK");
  EXPECT_NEAR(slack.amount, 0.5 * mm, 1e-12);
  EXPECT_EQ(slack.advice, "Take in tendons 1, 2 and 3 by 0.50 mm");
  const StateWords partly = told({0.1, 0}, {0.5 * mm, 0, 0.5 * mm, 0}).state;
  EXPECT_EQ(partly.word, "PARTLY SLACK");
  EXPECT_EQ(partly.advice, "Take in tendons 1 and 3 by 0.50 mm");
  const StateWords over = told({0.1, 0}, {-0.7 * mm, -0.7 * mm, -0.7 * mm}).state;
  EXPECT_EQ(over.word, "OVER-TENSIONED");
  EXPECT_EQ(over.advice, "Pay out tendons 1, 2 and 3 by 0.70 mm");
  const StateWords beyond = told({0.47, 0.1}, {0, 0, 0}).state;
  EXPECT_EQ(beyond.word, "UNREACHABLE");
  EXPECT_NEAR(beyond.amount, 0.47, 1e-12);
  EXPECT_EQ(beyond.advice, "Asked for 26.9°, limit 24.0°");
}

TEST(StateWords, NameOneTendonAsOne) {
  const std::vector<std::size_t> one = {2}, two = {0, 3};
  EXPECT_EQ(tendon_names(one), "tendon 3");
  EXPECT_EQ(tendon_names(two), "tendons 1 and 4");
}

TEST(StateWords, NearTheLimitIsWithinFivePercentOfTheEnvelope) {
  const auto is_near = [](double x, double y, const Envelope& envelope) {
    return told({x * deg, y * deg}, {0, 0, 0}, envelope).state.is_near_limit;
  };
  const Envelope square{Kind::square, 24 * deg}, disc{Kind::disc, 24 * deg};
  EXPECT_FALSE(is_near(22.7, 22.7, square));
  EXPECT_TRUE(is_near(22.9, 0, square));
  EXPECT_TRUE(is_near(-1, -22.9, square));
  EXPECT_TRUE(is_near(30, 0, square));
  EXPECT_FALSE(is_near(16, 16, disc));
  EXPECT_TRUE(is_near(16.3, 16.3, disc));
  // 4 joints about each axis of 2.45 mm
  const Envelope travel{Kind::actuator, 4 * 2.45 * mm * 24 * deg};
  EXPECT_TRUE(is_near(22.9, 0, travel));
  EXPECT_FALSE(is_near(22.7, 0, travel));
  const StateWords beyond = told({30 * deg, 0}, {0, 0, 0}, travel).state;
  EXPECT_EQ(beyond.advice, "Asked for 5.13 mm of a tendon, limit 4.11 mm");
}

TEST(StateWords, WithoutToleranceNothingIsTakenInThatIsTaut) {
  const Told exact = told({0, 0}, {0, 0, 0, 0});
  EXPECT_EQ(exact.diagram.agree, TendonConsistency::exact);
  EXPECT_EQ(exact.state.advice, "");
}

}  // namespace state_test
}  // namespace sinew
