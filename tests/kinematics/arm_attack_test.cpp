/// Random arms under random tendons and loads: every answer that says so is an equilibrium, which twice as
/// fine polynomials find again; all else is refused. SINEW_ARMS sets how many, `400` or from `9600:10000`.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <random>

#include "arms.hpp"

namespace sinew::test {
namespace arm_attack_test {

class Draw {
 public:
  explicit Draw(unsigned seed) : gen_(seed) {}
  double between(double a, double b) { return std::uniform_real_distribution<double>(a, b)(gen_); }
  double by_size(double a, double b) { return std::exp(between(std::log(a), std::log(b))); }
  int whole(int a, int b) { return std::uniform_int_distribution<int>(a, b)(gen_); }
  bool one_in(int n) { return whole(1, n) == 1; }

 private:
  std::mt19937 gen_;
};

Arm random_arm(Draw& draw) {
  Arm arm;
  const int sections = draw.whole(1, 3);
  const double length = draw.by_size(0.03, 0.5), slender = draw.between(60, 400);
  for (int m = 0; m < sections; ++m) {
    ArmSection section;
    section.length = length * draw.between(0.5, 1.5);
    const Material material{draw.by_size(1e9, 2e11), draw.by_size(4e8, 8e10), draw.between(1000, 8000)};
    section.start = section.end = round_section(material, length / slender);
    if (draw.one_in(4))
      section.end = round_section(material, 0.7 * length / slender), section.round_taper = true;
    if (draw.one_in(4)) section.curvature = {draw.between(-1, 1) / length, draw.between(-1, 1) / length, 0};
    section.discs.count = draw.one_in(4) ? 0 : draw.whole(4, 12);
    section.discs.mass = draw.one_in(2) ? 0.001 : 0;
    arm.sections.push_back(section);
    const int tendons = draw.whole(2, 4);
    const double radius = length * draw.between(0.03, 0.08), angle = draw.between(0, 6);
    for (int i = 0; i < tendons; ++i) {
      ArmTendon tendon = tendon_at(m, radius, angle + 2 * std::numbers::pi * i / tendons);
      if (draw.one_in(5)) tendon.routes.back().end_radius *= 0.6;
      if (draw.one_in(5)) tendon.routes.back().end_angle += draw.between(-1.5, 1.5);
      arm.tendons.push_back(tendon);
    }
  }
  if (draw.one_in(2)) arm.gravity = {draw.between(-7, 7), draw.between(-7, 7), draw.between(-7, 7)};
  return arm;
}

/// An arm, how its tendons are held and what loads it.
struct Question {
  Arm arm;
  std::vector<TendonCommand> commands = {};
  ArmLoad load = {};
};

Question random_question(int round) {
  Draw draw(static_cast<unsigned>(round) + 1);
  Question asked{.arm = random_arm(draw)};
  Arm& arm = asked.arm;
  // sizes that bend the arm by about a radian
  double bending = 1e300, radius = 1;
  for (const ArmSection& section : arm.sections)
    bending = std::min(bending, section.end.bending_x / section.length);
  for (const ArmTendon& tendon : arm.tendons) radius = std::min(radius, tendon.routes.back().end_radius);
  const double force = bending / arm.length(), tension = bending / radius;
  const bool by_change = draw.one_in(2);
  auto& commands = asked.commands;
  for (ArmTendon& tendon : arm.tendons) {
    tendon.compliance = radius / tension * draw.by_size(1e-3, 0.1);
    if (by_change)
      commands.push_back({TendonHeld::change, radius * draw.between(-0.5, 0.5)});
    else
      commands.push_back({TendonHeld::tension, std::max(0.0, tension * draw.between(-0.5, 1.2))});
  }
  ArmLoad& load = asked.load;
  if (!draw.one_in(3))
    for (std::size_t i = 0; i < 3; ++i) load.wrench[i] = force * draw.between(-1, 1);
  if (draw.one_in(3))
    for (std::size_t i = 3; i < 6; ++i) load.wrench[i] = bending * draw.between(-0.5, 0.5);
  if (draw.one_in(3))
    for (std::size_t i = 0; i < 6; ++i)
      load.following[i] = (i < 3 ? force : bending) * draw.between(-0.4, 0.4);
  if (draw.one_in(4)) load.along = {force / arm.length() * draw.between(-1, 1), 0, 0};
  if (draw.one_in(4)) {
    PointLoad point;
    point.place = arm.length() * draw.between(0.1, 0.9);
    for (std::size_t i = 0; i < 6; ++i)
      point.wrench[i] = (i < 3 ? force : 0.3 * bending) * draw.between(-0.5, 0.5);
    point.following = draw.one_in(3);
    load.points.push_back(point);
  }
  return asked;
}

TEST(ArmAttack, RandomArms) {
  const char* asked = std::getenv("SINEW_ARMS");
  int from = 0, count = 40;
  if (asked && std::sscanf(asked, "%d:%d", &from, &count) < 2) count = std::atoi(asked), from = 0;
  std::map<std::string, int> ended;
  int wrong = 0, other_branch = 0, too_low = 0;
  for (int round = from; round < count; ++round) {
    const Question question = random_question(round);
    const auto& arm = question.arm;
    const auto& commands = question.commands;
    const ArmLoad& load = question.load;
    ArmWorkspace work(arm);
    const ArmState state = arm_forward(arm, commands, load, {.accuracy = 1e-5}, work);
    ++ended[std::string(to_string(state.report.status))];
    if (!state.report.ok()) {
      EXPECT_FALSE(state.report.message.empty()) << round;
      if (std::getenv("SINEW_SHOW")) std::printf("round %d: %s\n", round, to_string(state.report).c_str());
      continue;
    }
    ASSERT_TRUE(std::isfinite(state.tip.p.norm()) && state.report.residual < 1e-7) << round;
    for (const double one : state.tensions) EXPECT_GE(one, 0) << round;
    ArmWorkspace finer(arm);
    const ArmState again =
        arm_forward(arm, commands, load, {.order = 6, .elements = 20, .accuracy = 0}, finer);
    if (!again.report.ok()) continue;
    const double off = (again.tip.p - state.tip.p).norm() / arm.length();
    if (off < 1e-3 && off * arm.length() > 3 * state.resolution + 1e-6 * arm.length()) ++too_low;
    if (off < 1e-4) continue;
    // Another equilibrium, or a wrong one? Finer polynomials must find it again from its shape or, where it
    // may turn freely as what is round, anew; beyond the finest the coarse ones tell.
    const auto is_there = [&](const ArmState& same, double near) {
      return same.report.ok() && same.coordinates != state.coordinates &&
             (same.tip.p - state.tip.p).norm() < near * arm.length();
    };
    const auto shape = arm_curvatures(arm, 60, work);
    const ArmState same = arm_forward(
        arm, commands, load, {.order = 6, .elements = 20, .accuracy = 0, .from_curvatures = shape}, finer);
    const auto stays = [&](double accuracy, double near) {
      ArmWorkspace other(arm);
      return is_there(arm_forward(arm, commands, load, {.accuracy = accuracy}, other), near);
    };
    if (is_there(same, 1e-4) || stays(1e-6, 1e-4) || stays(1e-7, 1e-4) || stays(1e-4, 1e-3)) {
      ++other_branch;
      continue;
    }
    ++wrong;
    std::printf(
        "round %d (%zu points): off by %.2e of the length, resolution %.2e, potential %.6g and %.6g; from "
        "its "
        "shape: %s\n",
        round, load.points.size(), off, state.resolution / arm.length(), state.energy, again.energy,
        to_string(same.report).c_str());
  }
  for (const auto& [status, number] : ended) std::printf("%s: %d\n", status.c_str(), number);
  std::printf("another branch: %d, not found again: %d, errors above three times what is told: %d\n",
              other_branch, wrong, too_low);
  EXPECT_EQ(wrong, 0);
}

/// A long section without discs under strong tendons needs many elements before errors fall with their fourth
/// power: what is told goes by how they do fall.
TEST(ArmAttack, ErrorsThatFallSlowlyAreToldSo) {
  const auto [arm, commands, load] = random_question(241);
  ArmWorkspace best(arm);
  const ArmState exact = arm_forward(arm, commands, load, {.order = 6, .elements = 20, .accuracy = 0}, best);
  ASSERT_TRUE(exact.report.ok());
  for (const double accuracy : {1e-4, 1e-5, 1e-6}) {
    ArmWorkspace work(arm);
    const ArmState state = arm_forward(arm, commands, load, {.accuracy = accuracy}, work);
    ASSERT_TRUE(state.report.ok()) << accuracy;
    EXPECT_LE((state.tip.p - exact.tip.p).norm(), 1.6 * state.resolution) << accuracy;
  }
}

/// A backbone in channels is cut into even spans: a load where one of them ends, or two at one place, cut
/// nothing more.
TEST(ArmAttack, LoadsWhereSpansEndAreAsThoseBesideThem) {
  const Arm arm = tendon_rod();
  const std::vector<TendonCommand> commands(arm.tendons.size());
  for (const ArmModel model :
       {ArmModel::rod, ArmModel::subsegment_rod, ArmModel::subsegment_cc, ArmModel::prb})
    for (const double share : {0.1, 0.3, 0.5, 1.0}) {
      const auto tip_at = [&](double place, int count) {
        ArmLoad load;
        for (int i = 0; i < count; ++i) load.points.push_back({place, {0.05 / count, 0, 0, 0, 0, 0}, false});
        ArmWorkspace work(arm);
        const ArmState state = arm_forward(arm, commands, load, {.model = model}, work);
        EXPECT_TRUE(state.report.ok()) << share << " " << to_string(state.report);
        return state.tip.p;
      };
      const double place = share * arm.length();
      const auto here = tip_at(place, 1);
      // chains take a load at the end of a link, so that beside it moves by a link's part
      EXPECT_LT((here - tip_at(place - 1e-7, 1)).norm(), model == ArmModel::prb ? 1e-3 : 1e-6) << share;
      EXPECT_LT((here - tip_at(place, 2)).norm(), 1e-9) << share;
      EXPECT_LT((here - tip_at(place - 1e-12, 1)).norm(), 1e-9) << share;
    }
}

}  // namespace arm_attack_test
}  // namespace sinew::test
