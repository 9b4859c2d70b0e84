// What a shell relies on: examples that work as printed, streams that do not break, signals, files.
#include "command.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>

namespace command_test {

using namespace sinew::test;

std::vector<std::string> verbs() {
  std::vector<std::string> names;
  const Scratch here;
  for (const std::string& line : lines_of(run_command({"help"}, here.path()).out))
    if (line.starts_with("  ") && !line.starts_with("  sinew"))
      names.push_back(line.substr(2, line.find(' ', 2) - 2));
  return names;
}

/// The lines below `Example:`.
std::string example(const std::string& help) {
  const std::size_t begin = help.find("Example:\n");
  return begin == std::string::npos ? std::string() : help.substr(begin + 9);
}

/// A plan of nottingham-tpcj: straight, then further in with one bend.
const std::string two_postures =
    "stage[m],S0_beta_1[rad],S0_beta_2[rad],S1_beta_1[rad],S1_beta_2[rad],S2_beta_1[rad],S2_beta_2[rad],"
    "S3_beta_1[rad],S3_beta_2[rad],S4_beta_1[rad],S4_beta_2[rad]\n0,0,0,0,0,0,0,0,0,0,0\n"
    "0.01,0.1,0,0,0,0,0,0,0,0,0\n";

/// The first rows that were measured of ftdcr-v4.
std::string few_rows() {
  std::string text;
  std::size_t rows = 0;
  for (const std::string& line :
       lines_of(read_text(std::filesystem::path(source_folder) / "data" / "measured" / "ftdcr-v4.csv")))
    if (line.starts_with('#') || rows++ < 40) text += line + '\n';
  return text;
}

TEST(Help, TheExampleOfEveryVerbWorksAsPrinted) {
  ASSERT_GE(verbs().size(), 9U);
  for (const std::string& verb : verbs()) {
    const Scratch here;
    const Outcome help = run_command({verb, "--help"}, here.path());
    ASSERT_EQ(help.exit, 0) << verb;
    EXPECT_EQ(help.out, run_command({"help", verb}, here.path()).out);
    const std::string line = example(help.out);
    ASSERT_FALSE(line.empty()) << verb;
    const std::string call =
        verb == "serve"  // it stays until it is told to end
            ? "sinew serve 3-rfr --port 0 -q >url & while [ ! -s url ] && kill -0 $!; do "
              "sleep 0.02; done; kill $!; wait $!"
            : line;
    if (verb == "drive") write_text(here.path() / "plan.csv", two_postures);
    if (verb == "identify") write_text(here.path() / "rows.csv", few_rows());
    const Outcome outcome = run_shell(call, here.path());
#ifndef SINEW_WITH_PLAN
    if (verb == "plan" || verb == "scene") {
      EXPECT_EQ(outcome.exit, 2);
      EXPECT_NE(outcome.err.find("libfcl-dev"), std::string::npos) << outcome.err;
      continue;
    }
#endif
    EXPECT_EQ(outcome.exit, 0) << line << outcome.err;
    EXPECT_EQ(outcome.err, "") << line;
  }
}

TEST(Help, WithoutArgumentsItGoesToStderr) {
  const Scratch here;
  const Outcome outcome = run_command({}, here.path());
  EXPECT_EQ(outcome.exit, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find("Usage: sinew"), std::string::npos);
}

class Stream : public testing::Test {
 protected:
  Outcome stream(const std::string& lines) {
    write_text(here_.path() / "lines", lines);
    return run_command({"query", "3-rfr"}, here_.path(), here_.path() / "lines");
  }
  Scratch here_;
};

constexpr const char* inverse = R"({"query": "inverse", "pose": {"x": 0.31, "y": 0, "phi": 0}})";

TEST_F(Stream, ALineOverOneMebibyteIsAnsweredAndTheNextOneToo) {
  const Outcome outcome =
      stream(std::string((1U << 20U) + 1, ' ') + '\n' + "x" + std::string(3U << 20U, 'x') + '\n' + inverse);
  EXPECT_EQ(outcome.exit, 0);
  const auto answers = lines_of(outcome.out);
  ASSERT_EQ(answers.size(), 2U);  // a blank line is skipped, however long
  EXPECT_NE(answers[0].find("too_large"), std::string::npos);
  EXPECT_NE(answers[1].find("unreachable"), std::string::npos);
}

TEST_F(Stream, ALineOfOneMebibyteIsRead) {
  const std::string query = inverse;
  const auto answers = lines_of(stream(query + std::string((1U << 20U) - query.size(), ' ') + '\n').out);
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_NE(answers[0].find("unreachable"), std::string::npos);
}

TEST_F(Stream, LineEndsOfWindowsAndAMissingLastOneAreRead) {
  const auto answers = lines_of(stream(std::string(inverse) + "\r\n\r\n" + inverse).out);
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[0], answers[1]);
}

TEST_F(Stream, NoLineEndsIt) {
  std::string lines;
  for (int byte = 1; byte < 256; ++byte)
    if (byte != '\n' && byte != ' ' && byte != '\t' && byte != '\r')
      lines += std::string(3, static_cast<char>(byte)) + '\n';
  lines += std::string("a\0b\n", 4) + std::string(5000, '[') + '\n' + inverse + '\n';
  const Outcome outcome = stream(lines);
  EXPECT_EQ(outcome.exit, 0);
  EXPECT_EQ(outcome.err, "");
  const auto answers = lines_of(outcome.out);
  ASSERT_EQ(answers.size(), static_cast<std::size_t>(std::ranges::count(lines, '\n')));
  for (std::size_t i = 0; i + 1 < answers.size(); ++i)
    EXPECT_NE(answers[i].find(R"("error")"), std::string::npos);
  EXPECT_NE(answers.back().find("unreachable"), std::string::npos);
}

TEST_F(Stream, AnswersComeInOrder) {
  std::string lines;
  for (int i = 0; i < 2000; ++i)
    lines +=
        R"({"query": "inverse", "pose": {"x": 0.31, "y": 0, "phi": 0}, "id": )" + std::to_string(i) + "}\n";
  const auto answers = lines_of(stream(lines).out);
  ASSERT_EQ(answers.size(), 2000U);
  for (std::size_t i = 0; i < answers.size(); ++i)
    EXPECT_TRUE(answers[i].starts_with("{\"id\":" + std::to_string(i) + ","));
}

TEST_F(Stream, EachAnswerComesBeforeTheNextQuestion) {
  const Outcome outcome =
      run_shell(std::string("mkfifo q a && { sinew query 3-rfr < q > a & } && exec 3> q 4< a && "
                            "for i in 1 2 3; do echo '") +
                    inverse +
                    "' >&3; read -r line <&4; done; "
                    "exec 3>&-; wait $!; echo \"$? $line\"",
                here_.path());
  EXPECT_TRUE(outcome.out.starts_with("0 {\"query\":\"inverse\"")) << outcome.out << outcome.err;
}

TEST_F(Stream, AReaderThatLeavesIsNoError) {
  const Outcome outcome =
      run_shell(std::string("{ yes '") + inverse + "' | { sinew query 3-rfr; echo $? >&2; } | head -n 1; }",
                here_.path());
  EXPECT_EQ(lines_of(outcome.out).size(), 1U);
  EXPECT_EQ(outcome.err.substr(0, 2), "4\n");
}

TEST_F(Stream, ASignalEndsItBetweenLines) {
  const Outcome outcome =
      run_shell(std::string("mkfifo q a && { sinew query 3-rfr < q > a & } && exec 3> q 4< a && echo '") +
                    inverse + "' >&3 && read -r line <&4 && kill -TERM $! && wait $!; echo $?",
                here_.path());
  EXPECT_EQ(outcome.out, "4\n") << outcome.err;
}

TEST(Check, NamesAFileWithBlanksAndUmlauts) {
  const Scratch here;
  write_text(here.path() / "mein Röbi.yaml", "sinew: 1\nname: x\nlegs: 3\n");
  const Outcome outcome = run_command({"check", "mein Röbi.yaml"}, here.path());
  EXPECT_EQ(outcome.exit, 2);
  EXPECT_TRUE(outcome.err.starts_with("mein Röbi.yaml:3:7: legs")) << outcome.err;
}

TEST(Plot, DrawsARobotInEveryFormat) {
  const Scratch here;
  for (const char* format : {"svg", "png", "pdf"}) {
    const std::string file = std::string("fig.") + format;
    const Outcome outcome =
        run_command({"plot", "3-rfr", "--pose", "10 mm, -5 mm, 10 deg", "-o", file}, here.path());
    EXPECT_EQ(outcome.exit, 0) << outcome.err;
    EXPECT_EQ(outcome.out, "fig.gp\n" + file + "\n");
    EXPECT_GT(std::filesystem::file_size(here.path() / file), 2000U);
  }
  const std::string script = read_text(here.path() / "fig.gp");
  for (const char* word : {"backbone", "tendon", "platform", "x\\175 (mm)"})
    EXPECT_NE(script.find(word), std::string::npos);
}

TEST(Plot, WithoutAPoseItDrawsTheHomeThatSetMoved) {
  const Scratch here;
  const auto drawn = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"plot", "3-rfr", "-o", "fig.svg"});
    EXPECT_EQ(run_command(more, here.path()).exit, 0);
    return read_text(here.path() / "fig.gp");
  };
  EXPECT_EQ(drawn({"--set", "platform.home.x=7 mm"}), drawn({"--pose", "7 mm, 0, 0"}));
}

TEST(Plot, DrawsRodsUnderALoadAndAtHome) {
  const Scratch here;
  const auto drawn = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"plot", "3pfs-g2", "-o", "fig.svg"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run_command(words, here.path());
    EXPECT_EQ(outcome.exit, 0) << outcome.err;
    return read_text(here.path() / "fig.gp");
  };
  const std::string home = drawn({}),
                    loaded =
                        drawn({"--inputs", "0.44 m, 0.42 m, 0.41 m", "--wrench", "0, 0, -30 N, 0, 0, 0"});
  EXPECT_NE(home.find("rod"), std::string::npos);
  EXPECT_EQ(home.find("rail"), std::string::npos);
  EXPECT_NE(loaded, drawn({"--inputs", "0.44 m, 0.42 m, 0.41 m"}));
}

TEST(Plot, DrawsWhatDoesNotHoldAndSaysSo) {
  const Scratch here;
  const Outcome outcome = run_command({"plot", "3pfs-g2", "--inputs", "434.7 mm, 434.7 mm, 434.7 mm",
                                       "--wrench", "0, 0, -115 N, 0, 0, 0", "-o", "fig.svg"},
                                      here.path());
  EXPECT_EQ(outcome.exit, 3);
  EXPECT_NE(outcome.err.find("unstable: 2 directions"), std::string::npos) << outcome.err;
  EXPECT_TRUE(std::filesystem::exists(here.path() / "fig.svg"));
}

TEST(Forward, AllListsEquilibriaOfRods) {
  const Scratch here;
  const Outcome outcome = run_command({"forward", "3pfs-g2", "--inputs", "434.7 mm, 434.7 mm, 434.7 mm",
                                       "--wrench", "0, 0, -100 N, 0, 0, 0", "--all"},
                                      here.path());
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("potential[mJ]  unstable_directions\n          1    0.0000"), std::string::npos)
      << outcome.out;
  EXPECT_NE(outcome.out.find("40604.4286                    1\n"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("\nat least "), std::string::npos);
}

TEST(New, EveryKindIsGoodAsItIs) {
  const Scratch here;
  const auto kinds = lines_of(run_command({"new"}, here.path()).err);
  int count = 0;
  for (std::size_t i = 3; i < kinds.size() && !kinds[i].empty(); ++i, ++count) {
    const std::string kind = kinds[i].substr(0, kinds[i].find(' '));
    write_text(here.path() / "mine.yaml", run_command({"new", kind}, here.path()).out);
    const Outcome outcome = run_command({"check", "mine.yaml"}, here.path());
#ifndef SINEW_WITH_PLAN
    if (kind == "scene") continue;
#endif
    EXPECT_EQ(outcome.exit, 0) << kind << outcome.err;
    EXPECT_EQ(outcome.err.find("home"), std::string::npos) << kind << outcome.err;
  }
  EXPECT_GE(count, 18);
}

TEST(Plot, DrawsColumnsOfATable) {
  const Scratch here;
  write_text(here.path() / "result.csv", "k,x[m],y[m],condition\n0,0.01,0.5,14.5\n1,0.02,0.25,150\n");
  const Outcome outcome = run_command(
      {"plot", "result.csv", "-o", "out/fig.svg", "--y", "x,y", "--log-y", "--title", "it's mine"},
      here.path());
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  const std::string script = read_text(here.path() / "out" / "fig.gp");
  EXPECT_NE(script.find("set logscale y"), std::string::npos);
  EXPECT_NE(script.find("0 10\n1 20\n"), std::string::npos);
  EXPECT_EQ(script.find("14.5"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(here.path() / "out" / "fig.svg"));
}

TEST(Plot, DrawsTextOfATableLiterally) {
  const Scratch here;
  write_text(here.path() / "evil.csv",
             "\"x'; system 'touch hacked' #[m]\",`touch hacked`[rad],\"v_{2} \\n $PATH @ARG1\"\n"
             "0,0,1\n1,0,2\n0,1,3\n1,1,5\n");
  for (const std::string kind : {"map", "contour", "points", "line"}) {
    const Outcome outcome = run_command(
        {"plot", "evil.csv", "--as", kind, "-o", "fig.svg", "--title", "'; system 'touch hacked'"},
        here.path());
    EXPECT_EQ(outcome.exit, 0) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(here.path() / "hacked"));
    EXPECT_NE(read_text(here.path() / "fig.svg").find("v_{2} \\n $PATH @ARG1"), std::string::npos) << kind;
  }
}

TEST(Plot, DrawsAGridInAnyOrderOfRowsTheSame) {
  const Scratch here;
  write_text(here.path() / "a.csv", "x[m],y[rad],v\n0,0,1\n1,0,2\n0,1,\n1,1,5\n");
  write_text(here.path() / "b.csv", "x[m],y[rad],v\n1,1,5\n0,0,1\n1,0,2\n");
  const auto script = [&](const char* table) {
    const Outcome outcome =
        run_command({"plot", table, "-o", "fig.png", "--as", "map", "--x", "x", "--y", "y"}, here.path());
    EXPECT_EQ(outcome.exit, 0) << outcome.err;
    return read_text(here.path() / "fig.gp");
  };
  EXPECT_EQ(script("a.csv"), script("b.csv"));  // a value that is missing, and a row that is
  EXPECT_NE(script("a.csv").find("<< EOD\n0 0 1\n1000 0 2\n1000 57.29577951308232 5\nEOD"),
            std::string::npos);
}

TEST(Plot, DrawsACutOfATableAtTheNearestValue) {
  const Scratch here;
  std::string table = "x[m],y[m],phi[rad],v\n";
  for (int k = 0; k < 27; ++k) table += fmt::format("{},{},{},{}\n", k % 3, k / 3 % 3, 0.1 * (k / 9), k);
  write_text(here.path() / "t.csv", table);
  const Outcome map = run_command({"plot", "t.csv", "-o", "fig.png", "--at", "phi = 5 deg"}, here.path());
  EXPECT_EQ(map.exit, 0) << map.err;
  const std::string script = read_text(here.path() / "fig.gp");
  EXPECT_NE(script.find("φ\\175 = 5.72958°"), std::string::npos);
  EXPECT_NE(script.find("<< EOD\n0 0 9\n1000 0 10\n"), std::string::npos);
  const Outcome line =
      run_command({"plot", "t.csv", "-o", "fig.png", "--at", "phi=0.2, y=1", "--y", "v"}, here.path());
  EXPECT_EQ(line.exit, 0) << line.err;
  EXPECT_NE(read_text(here.path() / "fig.gp").find("<< EOD\n0 21\n1000 22\n2000 23\nEOD"), std::string::npos);
}

TEST(Plot, RefusesAVectorFigureOfTooManyPoints) {
  const Scratch here;
  std::string table = "x,y\n";
  for (int k = 0; k < 200001; ++k) table += "1,2\n";
  write_text(here.path() / "t.csv", table);
  const Outcome outcome = run_command({"plot", "t.csv", "--as", "points", "-o", "fig.svg"}, here.path());
  EXPECT_EQ(outcome.exit, 2);
  EXPECT_NE(outcome.err.find("200001 points; an .svg or .pdf has 200000 at most"), std::string::npos)
      << outcome.err;
}

TEST(Plot, DrawsRobotsInSpace) {
  const Scratch here;
  const std::vector<std::vector<std::string>> robots{{"6-ufs"},
                                                     {"hexapod", "--view", "80 deg, 120 deg"},
                                                     {"nottingham-tpcj", "--configuration", "10 deg, 5 deg"}};
  for (std::vector<std::string> words : robots) {
    words.insert(words.begin(), "plot");
    words.insert(words.end(), {"--as", "3d", "-o", "fig.svg"});
    const Outcome outcome = run_command(words, here.path());
    EXPECT_EQ(outcome.exit, 0) << outcome.err;
    const std::string script = read_text(here.path() / "fig.gp");
    for (const char* word : {"set view equal xyz", "x\\175 (mm)", "y\\175 (mm)", "z\\175 (mm)", "splot"})
      EXPECT_NE(script.find(word), std::string::npos) << words[1] << ' ' << word;
  }
}

/// Tendons in the colours of their tensions, the others dashed, and a panel of the curvature.
TEST(Plot, DrawsArmsUnderTendonsAndLoads) {
  const Scratch here;
  const Outcome outcome = run_command({"plot", "two-segment", "--tensions", "4 N, 0, 0; 0, 2 N, 0",
                                       "--wrench", "0.1 N, 0, 0, 0, 0, 0", "-o", "arm.svg"},
                                      here.path());
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  const std::string script = read_text(here.path() / "arm.gp");
  for (const char* word : {"tension (N)", "tendon, 0 N", "curvature (1/m)"})
    EXPECT_NE(script.find(word), std::string::npos) << word;
  const Outcome home = run_command({"plot", "tendon-rod", "--as", "3d", "-o", "home.svg"}, here.path());
  EXPECT_EQ(home.exit, 0) << home.err;
}

TEST(Plot, DrawsTheDiagramOfASectionAsDiagramDoes) {
  const Scratch here;
  const std::vector<std::string> words{"nottingham-tpcj",        "--section", "0",      "--changes",
                                       "-1.1 mm, 2 mm, -0.5 mm", "-o",        "fig.svg"};
  const auto drawn = [&](std::string verb) {
    std::vector<std::string> all{std::move(verb)};
    all.insert(all.end(), words.begin(), words.end());
    const Outcome outcome = run_command(all, here.path());
    EXPECT_EQ(outcome.out, "fig.gp\nfig.svg\n");
    return read_text(here.path() / "fig.gp");
  };
  EXPECT_EQ(drawn("plot"), drawn("diagram"));
}

TEST(Plot, DrawsASpatialRobotFromTwoSides) {
  const Scratch here;
  const Outcome outcome =
      run_command({"plot", "6-ufs", "--pose", "0, 0, 190 mm, 0, 10 deg, 0", "-o", "fig.svg"}, here.path());
  EXPECT_EQ(outcome.exit, 0) << outcome.err;
  const std::string script = read_text(here.path() / "fig.gp");
  for (const char* word : {"x\\175 (mm)", "y\\175 (mm)", "z\\175 (mm)", "backbone"})
    EXPECT_NE(script.find(word), std::string::npos) << word;
}

TEST(Track, WritesAFileThatPlotDraws) {
  const Scratch here;
  const std::vector<std::string> path{
      "track",     "3-rfrr", "--from", "0, 0, 0",     "--to", "10 mm, 5 mm, 20 deg",
      "--samples", "5",      "-o",     "out/path.csv"};
  const Outcome outcome = run_command(path, here.path());
  ASSERT_EQ(outcome.exit, 0) << outcome.err;
  const auto lines = lines_of(read_text(here.path() / "out" / "path.csv"));
  ASSERT_EQ(lines.size(), 7U);
  EXPECT_TRUE(lines[1].starts_with("sample,x[m],y[m],phi[rad],legs[0].theta[rad],legs[0].tendon_1[m],"));
  const Outcome drawn = run_command(
      {"plot", "out/path.csv", "-o", "fig.svg", "--y", "legs[0].tendon_1,legs[1].tendon_1"}, here.path());
  EXPECT_EQ(drawn.exit, 0) << drawn.err;
}

TEST(Track, KeepsWhatItReached) {
  const Scratch here;
  const Outcome outcome = run_command({"track", "3-rfr", "--from", "0, 0, 0", "--to", "80 mm, 5 mm, 20 deg",
                                       "--samples", "11", "-o", "path.csv", "-q"},
                                      here.path());
  EXPECT_EQ(outcome.exit, 3);
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find("between poses 6 and 7 of 11"), std::string::npos) << outcome.err;
  EXPECT_EQ(lines_of(read_text(here.path() / "path.csv")).size(), 8U);
}

TEST(Plot, DrawsNothingWhereTheRobotCannotBe) {
  const Scratch here;
  const Outcome outcome =
      run_command({"plot", "3-rfr", "--pose", "310 mm, 0, 0", "-o", "fig.svg"}, here.path());
  EXPECT_EQ(outcome.exit, 3);
  EXPECT_TRUE(outcome.err.starts_with("plot 3-RFR: unreachable: legs[0]")) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(here.path() / "fig.svg"));
}

TEST(Reproduce, PrintsTheTableAndTheFilesItWrote) {
  const Scratch here;
  const Outcome outcome =
      run_command({"reproduce", "tdpcr/fig9", "-o", "made", "--width", "85 mm"}, here.path());
  ASSERT_EQ(outcome.exit, 0) << outcome.err;
  const auto lines = lines_of(outcome.out);
  EXPECT_TRUE(lines.at(0).starts_with("tdpcr/fig9: "));
  EXPECT_TRUE(lines.at(1).starts_with("quantity"));
  int files = 0;
  for (const std::string& line : lines) {
    if (!line.starts_with("made/")) continue;
    ++files;
    EXPECT_TRUE(std::filesystem::exists(here.path() / line)) << line;
  }
  EXPECT_GE(files, 2);
  EXPECT_NE(outcome.out.find(" | holds"), std::string::npos);
  EXPECT_NE(read_text(here.path() / "made" / "tdpcr" / "fig9.svg").find("width=\"85mm\""), std::string::npos);
}

}  // namespace command_test
