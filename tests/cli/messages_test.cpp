// Messages of the command are in words of the command: every verb, on robots of every kind, with every option
// of the verb beside what it needs.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <regex>

#include "command.hpp"
#include "thorough.hpp"

namespace messages_test {

using namespace sinew::test;
using Words = std::vector<std::string>;

/// A value that an option may have; of the dimension that it has for most robots.
const std::map<std::string, std::string> samples{{"inputs", "0.19, 0.19, 0.188"},
                                                 {"pose", "10 mm, 0, 5 deg"},
                                                 {"independent", "0.39 m, 0.1, 0.05"},
                                                 {"configuration", "10 deg, 5 deg"},
                                                 {"position", "60 mm, 20 mm, 120 mm"},
                                                 {"direction", "0, 0, 1"},
                                                 {"changes", "-1 mm, 0.5 mm, 0.5 mm"},
                                                 {"slack", "0.1 mm"},
                                                 {"measured", "-1 mm, 0.5 mm, 0.5 mm"},
                                                 {"section", "0"},
                                                 {"tolerance", "0.1 mm"},
                                                 {"envelope", "square"},
                                                 {"from", "0, 0, 0"},
                                                 {"to", "10 mm, 0, 5 deg"},
                                                 {"to-inputs", "0.44, 0.42, 0.41"},
                                                 {"to-wrench", "0, 0, -1 N, 0, 0, 0"},
                                                 {"range", "0, 1"},
                                                 {"samples", "3"},
                                                 {"objective", "none"},
                                                 {"start", "0, 0, 0"},
                                                 {"bending", "+,+,+"},
                                                 {"elbow", "+,+,+"},
                                                 {"curvature", "1, 1, 1"},
                                                 {"theta-is", "chord"},
                                                 {"twist", "1 mm/s, 0, 1 deg/s"},
                                                 {"wrench", "10 mN, 0, 0"},
                                                 {"gravity", "0, 0, -9.81"},
                                                 {"set-at", "0, 0, 5 deg"},
                                                 {"hold", "tension"},
                                                 {"tensions", "1, 0; 1, 0; 1, 0"},
                                                 {"lengths", "0.19, -; 0.19, -; 0.19, -"},
                                                 {"axial-forces", "0, 0, 0, 0, 0, 0"},
                                                 {"deviation", "10 mN"},
                                                 {"law", "M0"},
                                                 {"posture-threshold", "1 deg"},
                                                 {"rk4-steps", "3"},
                                                 {"want", "stability"},
                                                 {"until", "0, 0, 1 mN m"},
                                                 {"limit", "2"},
                                                 {"max-iterations", "50"},
                                                 {"model", "prb"},
                                                 {"set", "platform.radius=40 mm"},
                                                 {"x", "0 : 1 mm : 2"},
                                                 {"y", "0"},
                                                 {"z", "0"},
                                                 {"phi", "0"},
                                                 {"rx", "0"},
                                                 {"ry", "0"},
                                                 {"rz", "0"},
                                                 {"output", "a.csv"}};

struct Kind {
  std::string robot, inputs, pose, wrench;
};
const Kind kinds[] = {
    {"3-rfr", "0.19, 0.19, 0.188", "10 mm, 0, 5 deg", "10 mN, 0, 0"},
    {"3-rfrr", "-1.7, 0.15, 1.2, 0.15, 2.3, 0.15", "10 mm, 0, 5 deg", "10 mN, 0, 0"},
    {"6-ufs", "0.24, 0.24, 0.24, 0.24, 0.24, 0.24", "0, 0, 180 mm, 0, 0, 0", "0, 0, -0.1 N, 0, 0, 0"},
    {"3prs", "0.2, 0.22, 0.21", "0, 0, 540 mm, 0, 0, 0", "0, 0, -1 N, 0, 0, 0"},
    {"3pfs-g2", "0.44, 0.42, 0.41", "0, 0, 390 mm, 0, 0, 0", "0, 0, -1 N, 0, 0, 0"},
    {"hexapod", "0.41, 0.41, 0.405, 0.405, 0.405, 0.405", "0, 0, 400 mm, 0, 0, 0", "0, 0, -1 N, 0, 0, 0"},
    {"nottingham-tpcj", "0, 0, 0", "0, 0, 175 mm, 0, 0, 0", "0, 0, -1 N, 0, 0, 0"}};

std::string value_of(const std::string& option, const Kind& kind) {
  if (option == "inputs" || option == "to-inputs") return kind.inputs;
  if (option == "pose" || option == "from" || option == "to" || option == "set-at" || option == "start")
    return kind.pose;
  if (option == "wrench" || option == "until" || option == "to-wrench") return kind.wrench;
  const auto found = samples.find(option);
  return found == samples.end() ? "" : found->second;
}

/// Its options that have a value, as its help lists them.
Words options_of(const std::string& verb, const Scratch& here) {
  static const std::regex line(R"(  (?:-\w, |    )--([a-z0-9-]+) (\S?).*)");
  Words names;
  for (const std::string& text : lines_of(run_command({verb, "--help"}, here.path()).out))
    if (std::smatch match; std::regex_match(text, match, line) && samples.contains(match[1]))
      names.push_back(match[1]);
  return names;
}

/// Names that only JSON has, where an option has another one; and paths of fields that are options.
const std::regex json_words(
    R"((^|[^-\w./"\[])((set_at|theta_is|max_iterations|rk4_steps|posture_threshold|axial_forces)\b|(until|to)\.(limit|wrench|inputs|pose)|(pose|inputs|wrench|from|twist|start|configuration|changes|position|direction|tensions|lengths|curvature|bending)[.\[]\w|model: \w))");

TEST(Messages, NameOptionsAndNotTheFieldsOfQueries) {
  const Scratch here;
  const std::map<std::string, Words> verbs{{"forward", {"inputs", "changes"}},
                                           {"inverse", {"pose", "independent", "position"}},
                                           {"statics", {"set-at", "pose", "tensions", "axial-forces"}},
                                           {"analyse", {"pose", "inputs"}},
                                           {"diagram", {"changes"}},
                                           {"track", {"from"}},
                                           {"branches", {"to-wrench"}},
                                           {"map", {"x"}}};
  // A process takes long to begin: every option of every verb is put to robots of one or two kinds of
  // seven, in turn, beside each thing that the verb may need.
  const auto every = count_of<std::size_t>(5, 1);
  std::size_t turn = 0;
  int count = 0, refused = 0;
  for (const auto& [verb, needs] : verbs) {
    const Words options = options_of(verb, here);
    ASSERT_GT(options.size(), 3U) << verb;
    for (const std::string& need : needs)
      for (const std::string& option : options) {
        ++turn;
        for (std::size_t k = turn % every; k < std::size(kinds); k += every) {
          const Kind& kind = kinds[k];
          Words words{verb,   kind.robot, "--" + need, value_of(need, kind),
                      "--to", kind.pose,  "--samples", "3"};
          if (verb != "track") words.resize(4);
          if (option != need && !(verb == "track" && (option == "to" || option == "samples")))
            words.insert(words.end(), {"--" + option, value_of(option, kind)});
          if (option == "until") words.insert(words.end(), {"--limit", "2"});
          ++count;
          const Outcome outcome = run_command(words, here.path());
          refused += outcome.exit == 2 ? 1 : 0;
          const std::string line = fmt::format("{}\n{}", fmt::join(words, " "), outcome.err);
          EXPECT_TRUE(outcome.exit == 0 || (outcome.exit > 1 && outcome.exit <= 4)) << line;
          EXPECT_FALSE(std::regex_search(outcome.err, json_words)) << line;
          if (outcome.exit != 0) {
            EXPECT_NE(outcome.err, "") << line;
          }
        }
      }
  }
  fmt::print("{} commands, {} refused\n", count, refused);
}

TEST(Messages, ArmsNameOptionsToo) {
  const Scratch here;
  const auto said = [&](const Words& more) {
    Words words{"forward", "two-segment"};
    words.insert(words.end(), more.begin(), more.end());
    return run_command(words, here.path()).err;
  };
  EXPECT_EQ(
      said({"--tensions", "4, 0, 0; 0, 2, 0", "--accuracy", "1e-11"}),
      "forward two-segment: stalled: the finest polynomials still move the tip by 1.1e-10 m, --accuracy "
      "1e-11 asks for 4.0e-12 m: give --accuracy 3e-10 or more, or smaller loads and tensions\n");
  const std::string none = said({"--changes=-0.05, -0.05, -0.05; 0, 0, 0"});
  EXPECT_NE(none.find("; --all looks from other shapes, too"), std::string::npos) << none;
}

TEST(Messages, NumbersFarOutsideTheRobotAreHintedAt) {
  const Scratch here;
  const std::pair<Words, std::string> cases[] = {
      {{"inverse", "3-rfr", "--pose", "10, -5, 10"},
       R"(--pose.x is 10 m, 14.71 times the robot's size (680 mm); did you mean "10 mm"?)"},
      {{"inverse", "3-rfr", "--pose", "0.01, 0, 45"},
       R"(--pose.phi is 45 rad, 7.16 turns; did you mean "45 deg"?)"},
      {{"inverse", "hexapod", "--pose", "0, 0.07, 0.53, 0, 0, 45"},
       R"(--pose: a rotation of 45 rad is 7.16 turns; did you mean "45 deg"?)"},
      {{"forward", "3-rfr", "--inputs", "190, 190, 188"}, R"(did you mean "190 mm"?)"},
      {{"forward", "3pfs-g2", "--inputs", "440, 420, 410"}, R"(--inputs[0] is 440 m)"},
      {{"forward", "3-rfr", "--inputs", ".19, .19, .19", "--set", "legs[0].link.length=200"},
       R"(legs[0].link.length is 200 m)"},
      {{"statics", "3-rfr", "--set-at", "10 mm, 0, 20 deg", "--wrench", "30, 20, 5"},
       R"(--wrench[0] is 30 N)"},
      {{"analyse", "3-rfr", "--pose", "10, 0, 0"}, R"(--pose.x is 10 m)"},
      {{"track", "3-rfr", "--from", "0, 0, 0", "--to", "10, 5, 20"}, R"(--to.x is 10 m)"},
      {{"diagram", "nottingham-tpcj", "--section", "0", "--changes", "-1.1, 2, -0.5"},
       R"(--changes[0] is -1.1 m)"},
      {{"inverse", "nottingham-tpcj", "--position", "60, 20, 120"}, R"(--position[0] is 60 m)"},
      {{"forward", "nottingham-tpcj", "--configuration", "10, 5"}, R"(--configuration[0][0] is 10 rad)"},
      {{"plot", "3-rfr", "--pose", "0, 0, 20", "-o", "a.svg"}, R"(--pose.phi is 20 rad)"}};
  for (const auto& [words, said] : cases) {
    const Outcome outcome = run_command(words, here.path());
    EXPECT_NE(outcome.exit, 2) << outcome.err;  // a hint, not a refusal
    EXPECT_NE(outcome.err.find(said), std::string::npos)
        << fmt::format("{}\n{}", fmt::join(words, " "), outcome.err);
  }
  for (const Words& words :
       {Words{"inverse", "3-rfr", "--pose", "10 mm, -5 mm, 10 deg"},
        Words{"forward", "3pfs-g2", "--inputs", "0.44, 0.42, 0.41", "--wrench", "0, 0, -20 N, 0, 0, 0"}}) {
    EXPECT_EQ(run_command(words, here.path()).err, "");
  }
}

}  // namespace messages_test
