// What the command says of itself: lists, completions, a page for man. All are made of the same tables.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "command.hpp"

namespace texts_test {

using namespace sinew::test;

struct VerbText {
  std::string name;
  std::vector<std::string> options;
};

/// Verbs and their options, as their help has them.
const std::vector<VerbText>& verbs() {
  static const std::vector<VerbText> all = [] {
    std::vector<VerbText> found;
    const Scratch here;
    for (const std::string& line : lines_of(run_command({"help"}, here.path()).out)) {
      if (!line.starts_with("  ") || line.starts_with("  sinew")) continue;
      VerbText verb{line.substr(2, line.find(' ', 2) - 2), {}};
      for (const std::string& row : lines_of(run_command({verb.name, "--help"}, here.path()).out)) {
        const std::size_t dashes = row.find("--");
        if (!row.starts_with("  ") || row.starts_with("  sinew") || (dashes != 6)) continue;
        verb.options.push_back(row.substr(dashes + 2, row.find(' ', dashes) - dashes - 2));
      }
      found.push_back(std::move(verb));
    }
    return found;
  }();
  return all;
}

bool has_program(const std::string& name) {
  const Scratch here;
  return run_shell("command -v " + name + " >/dev/null", here.path()).exit == 0;
}

TEST(Texts, KnowEveryVerbAndOption) {
  ASSERT_GE(verbs().size(), 18U);
  const Scratch here;
  const std::string bash = run_command({"completion", "bash"}, here.path()).out,
                    zsh = run_command({"completion", "zsh"}, here.path()).out,
                    fish = run_command({"completion", "fish"}, here.path()).out,
                    man = run_command({"help", "--man"}, here.path()).out;
  const auto has = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  for (const VerbText& verb : verbs()) {
    ASSERT_FALSE(verb.options.empty()) << verb.name;
    EXPECT_TRUE(has(bash, fmt::format("\n    {}) options=\"", verb.name))) << verb.name;
    EXPECT_TRUE(has(man, fmt::format("\n.SS \\fB{}\\fR", verb.name))) << verb.name;
    const std::size_t in_bash = bash.find(fmt::format("\n    {}) options=\"", verb.name)),
                      in_zsh = zsh.find(fmt::format("\n    {})\n", verb.name));
    ASSERT_NE(in_zsh, std::string::npos) << verb.name;
    const std::string bash_part = bash.substr(in_bash, bash.find('\n', in_bash + 1) - in_bash),
                      zsh_part = zsh.substr(in_zsh, zsh.find(";;", in_zsh) - in_zsh);
    for (const std::string& option : verb.options) {
      EXPECT_TRUE(has(bash_part, "--" + option + " ") || has(bash_part, "--" + option + "\"")) << option;
      EXPECT_TRUE(has(zsh_part, "--" + option + "[") || has(zsh_part, "--" + option + "}"))
          << verb.name << ' ' << option;
      EXPECT_TRUE(has(fish, fmt::format("'__sinew_verb {}' -l {} ", verb.name, option))) << option;
      std::string dashed = option;
      for (std::size_t at = 0; (at = dashed.find('-', at)) != std::string::npos; at += 2)
        dashed.replace(at, 1, "\\-");
      EXPECT_TRUE(has(man, fmt::format("\\fB\\-\\-{}\\fR", dashed))) << option;
    }
  }
}

TEST(Texts, CompletionsAreGoodForTheirShells) {
  const Scratch here;
  for (const char* shell : {"bash", "zsh", "fish"}) {
    if (!has_program(shell)) continue;
    const Outcome outcome =
        run_shell(fmt::format("sinew completion {0} > script; {0} -n script", shell), here.path());
    EXPECT_EQ(outcome.exit, 0) << shell << outcome.err;
    EXPECT_EQ(outcome.err, "") << shell;
  }
  EXPECT_EQ(run_command({"completion", "tcsh"}, here.path()).exit, 2);
}

TEST(Texts, BashCompletesVerbsOptionsAndOperands) {
  const Scratch here;
  write_text(here.path() / "mine.yaml", "");
  const auto completed = [&](const std::string& words, int at) {
    return run_shell("bash -c 'source <(sinew completion bash); COMP_WORDS=(sinew " + words +
                         "); COMP_CWORD=" + std::to_string(at) + "; _sinew; echo ${COMPREPLY[@]}'",
                     here.path())
        .out;
  };
  EXPECT_EQ(completed("inv", 1), "inverse\n");
  EXPECT_EQ(completed("inverse 3-rfr --be", 3), "--bending\n");
  EXPECT_EQ(completed("track 3-rfr --obj", 3), "--objective\n");
  EXPECT_EQ(completed("forward 3pfs-g2 --wr", 3), "--wrench\n");
  EXPECT_EQ(completed("forward 3pfs", 2), "3pfs-g1 3pfs-g2\n");
  EXPECT_EQ(completed("check 6-", 2), "6-ufs\n");
  EXPECT_EQ(completed("check 3pfs-t", 2), "3pfs-tilt\n");
  EXPECT_EQ(completed("check m", 2), "mine.yaml\n");
  EXPECT_EQ(completed("identify mi", 2), "mine.yaml\n");
  EXPECT_EQ(completed("identify ftdcr-v4 --hold", 3), "--hold-out\n");
  EXPECT_EQ(completed("reproduce tdpcr/fig9", 2), "tdpcr/fig9\n");
  EXPECT_EQ(completed("new hexa", 2), "hexapod\n");
  EXPECT_EQ(completed("list s", 2), "studies\n");
  EXPECT_EQ(completed("help un", 2), "units\n");
  EXPECT_EQ(completed("completion z", 2), "zsh\n");
}

TEST(Texts, BashCompletesWordsOfOptions) {
  const Scratch here;
  const auto completed = [&](const std::string& words, int at) {
    return run_shell("bash -c 'source <(sinew completion bash); COMP_WORDS=(sinew " + words +
                         "); COMP_CWORD=" + std::to_string(at) + "; _sinew; echo ${COMPREPLY[@]}'",
                     here.path())
        .out;
  };
  EXPECT_EQ(completed("forward 3pfs-g2 --want st", 4), "stiffness stability\n");
  EXPECT_EQ(completed("forward 3pfs-g2 --want stiffness,pose,ma", 4), "stiffness,pose,margins\n");
  EXPECT_EQ(completed("forward 3-rfr --model p", 4), "prb pcc\n");
  EXPECT_EQ(completed("forward 3-rfr --model =", 4), completed("forward 3-rfr --model \"\"", 4));
  EXPECT_EQ(completed("forward 3-rfr --model = pr", 5), "prb\n");
  EXPECT_EQ(completed("forward 3-rfr --theta-is t", 4), "tangent\n");
  EXPECT_EQ(completed("plot 3-rfr --as 3", 4), "3d\n");
  EXPECT_EQ(completed("sweep 3-rfr-workspace --isa n", 4), "native\n");
  EXPECT_EQ(completed("forward 3-rfr --as 3", 4), "\n");  // it has no such option
  EXPECT_EQ(completed("forward 3-rfr --model prb --wan", 5), "--want\n");
  // they are those that plot draws
  std::string kinds = completed("plot 3-rfr --as \"\"", 4), drawn;
  const std::string said = run_command({"plot", "3-rfr", "--as", "x", "-o", "x.svg"}, here.path()).err;
  for (const std::string word : {"line", "points", "map", "contour", "sides", "3d", "diagram"}) {
    drawn += word + (word == "diagram" ? "\n" : " ");
    EXPECT_NE(said.find(word), std::string::npos) << said;
  }
  EXPECT_EQ(kinds, drawn);
}

TEST(Texts, FishCompletesVerbsOptionsAndOperands) {
  if (!has_program("fish")) GTEST_SKIP() << "there is no fish";
  const Scratch here;
  write_text(here.path() / "mine.yaml", "");
  const auto completed = [&](const std::string& line) {
    std::string words;
    for (const std::string& found : lines_of(
             run_shell("HOME=$PWD fish -N -c 'sinew completion fish | source; complete -C \"" + line + "\"'",
                       here.path())
                 .out))
      words += found.substr(0, found.find('\t')) + ' ';
    return words;
  };
  EXPECT_EQ(completed("sinew inv"), "inverse ");
  EXPECT_EQ(completed("sinew inverse 3-rfr --be"), "--bending ");
  EXPECT_EQ(completed("sinew forward 3pfs-g"), "3pfs-g1 3pfs-g2 ");
  EXPECT_EQ(completed("sinew check mi"), "mine.yaml ");
  EXPECT_EQ(completed("sinew list r"), "robots ");
  EXPECT_EQ(completed("sinew forward 3-rfr --model pr"), "prb ");
  EXPECT_EQ(completed("sinew forward 3-rfr --model=pr"), "--model=prb ");
  EXPECT_EQ(completed("sinew forward 3-rfr --want stiffness,ma"), "stiffness,margins ");
  EXPECT_EQ(completed("sinew plot 3-rfr --as con"), "contour ");
}

TEST(Texts, ZshCompletesVerbsOptionsAndOperands) {
  if (!has_program("zsh")) GTEST_SKIP() << "there is no zsh";
  const Scratch here;
  // A completion runs in zsh's editor alone: one in a terminal of its own, which is asked what a key would
  // list.
  write_text(here.path() / "ask.zsh", R"zsh(
zmodload zsh/zpty
zpty z zsh -f -i
zpty -w z 'PS1=; fpath=($PWD $fpath); autoload -Uz compinit; compinit -u -d ./dump; bindkey "^I" complete-word'
zpty -w z 'zstyle ":completion:*" list-grouped false; zstyle ":completion:*" insert-tab false; echo rea""dy'
zpty -r -m z seen '*ready*'
zpty -w -n z "$1"$'\t'
zpty -r -m z seen "*$1*$2*" && print found
)zsh");
  const auto completes = [&](const std::string& begun, const std::string& whole) {
    const Outcome outcome = run_shell(
        fmt::format("sinew completion zsh > _sinew; timeout 20 zsh -f ask.zsh '{}' '{}'", begun, whole),
        here.path());
    return outcome.out.find("found") != std::string::npos;
  };
  EXPECT_TRUE(completes("sinew inv", "erse"));
  EXPECT_TRUE(completes("sinew inverse 3-rfr --bend", "ing"));
  EXPECT_TRUE(completes("sinew new hexa", "pod"));
  EXPECT_TRUE(completes("sinew forward 3-rfr --model pr", "b"));
  EXPECT_TRUE(completes("sinew forward 3-rfr --want stiffness,ma", "rgins"));
  EXPECT_TRUE(completes("sinew plot 3-rfr --as con", "tour"));
}

TEST(Texts, ThePageForManHasNoMistakesOfTroff) {
  if (!has_program("groff")) GTEST_SKIP() << "there is no groff";
  const Scratch here;
  const Outcome outcome = run_shell("sinew help --man | groff -man -ww -Tutf8 -P-cbou", here.path());
  EXPECT_EQ(outcome.exit, 0);
  EXPECT_EQ(outcome.err, "");
  for (const char* part : {"--max-iterations", "EXIT STATUS", "K·(input", "NO_COLOR"})
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part;
}

TEST(List, HasALineForEachThingThatComesWithIt) {
  const Scratch here;
  const auto robots = lines_of(run_command({"list", "robots"}, here.path()).out);
  const auto all = lines_of(run_command({"list"}, here.path()).out);
  const auto json = nlohmann::json::parse(run_command({"list", "--json"}, here.path()).out);
  EXPECT_EQ(robots.size(), json.at("robots").size() + 1);
  EXPECT_EQ(all.size(), json["robots"].size() + json.at("studies").size() + json.at("figures").size() + 5);
  for (const char* kind : {"robots", "studies", "figures"})
    for (const auto& entry : json.at(kind))
      EXPECT_FALSE(entry.at("title").get<std::string>().empty()) << entry;
  for (const auto& entry : json["robots"])  // each can be opened
    EXPECT_EQ(run_command({"check", entry["name"], "-q"}, here.path()).exit, 0) << entry;
}

TEST(Version, IsFoundHoweverItIsAskedFor) {
  const Scratch here;
  const std::string version = run_command({"--version"}, here.path()).out;
  EXPECT_TRUE(version.starts_with("sinew "));
  EXPECT_EQ(run_command({"-V"}, here.path()).out, version);
  EXPECT_EQ(run_command({"version"}, here.path()).out, version);
  for (const char* slip : {"--versoin", "--vesion", "-v", "-version", "--Version"}) {
    const Outcome outcome = run_command({slip}, here.path());
    EXPECT_EQ(outcome.exit, 2) << slip;
    EXPECT_NE(outcome.err.find("did you mean --version?"), std::string::npos) << outcome.err;
  }
  EXPECT_NE(run_command({"versoin"}, here.path()).err.find("did you mean version?"), std::string::npos);
}

}  // namespace texts_test
