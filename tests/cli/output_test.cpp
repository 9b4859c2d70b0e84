// What the verbs write: whole or not at all, and nothing of a text is a command to gnuplot or to a terminal.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <map>
#include <set>

#include "command.hpp"
#include "paths.hpp"
#include "sanitizers.hpp"
#include "thorough.hpp"

namespace output_test {

using namespace sinew::test;
namespace fs = std::filesystem;

const std::string study = R"(sinew: 1
robot: 3-frr
query: {query: inverse, pose: {x: $x, y: $y, phi: 0.1}}
axes:
  y: {from: -120 mm, to: 120 mm, count: 7}
  x: {from: -120 mm, to: 120 mm, count: 9}
)";

/// One command line that writes, and an earlier one whose files it replaces.
struct Writing {
  std::string name;
  std::vector<std::string> words, earlier;
  std::vector<std::string> files;
};

std::vector<Writing> writings() {
  std::vector<Writing> all;
  for (const std::string format : {"svg", "png", "pdf"})
    all.push_back({"plot " + format,
                   {"plot", "3-rfr", "-q", "-o", "f." + format},
                   {"plot", "3-rfr", "-q", "--pose", "10 mm, 0, 0", "-o", "f." + format},
                   {"f.gp", "f." + format}});
  all.push_back({"plot of a table",
                 {"plot", "t.csv", "-q", "-o", "f.svg"},
                 {"plot", "3-rfr", "-q", "-o", "f.svg"},
                 {"f.gp", "f.svg"}});
  const std::vector<std::string> grid{
      "map", "3-rfr", "-q", "--x", "-60 mm : 60 mm : 7", "--y", "-60 mm : 60 mm : 7"};
  const auto with = [](std::vector<std::string> words, const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  all.push_back(
      {"map csv", with(grid, {"-o", "f.csv"}), with(grid, {"--phi", "30 deg", "-o", "f.csv"}), {"f.csv"}});
  all.push_back({"map svg",
                 with(grid, {"-o", "f.svg"}),
                 with(grid, {"--phi", "30 deg", "-o", "f.svg"}),
                 {"f.gp", "f.svg"}});
  all.push_back({"track",
                 {"track", "3-rfr", "-q", "--from", "0, 0, 0", "--to", "10 mm, 5 mm, 20 deg", "-o", "f.csv"},
                 {"track", "3-rfr", "-q", "--from", "0, 0, 0", "--to", "5 mm, 5 mm, 0", "-o", "f.csv"},
                 {"f.csv"}});
  all.push_back({"export c-header",
                 {"export", "nottingham-tpcj", "-q", "--to", "c-header", "-o", "f.h"},
                 {"export", "nottingham-tpcj", "-q", "--to", "c-header", "--model", "pcc", "-o", "f.h"},
                 {"f.h"}});
  all.push_back({"diagram",
                 {"diagram", "nottingham-tpcj", "-q", "--section", "0", "--changes", "-1.1 mm, 2 mm, -0.5 mm",
                  "-o", "f.svg"},
                 {"plot", "3-rfr", "-q", "-o", "f.svg"},
                 {"f.gp", "f.svg"}});
  all.push_back({"branches csv",
                 {"branches", "3pfs-g2", "-q", "--independent", "0.4 m, 0.05, 0", "--to-wrench",
                  "0, 0, -20 N, 0, 0, 0", "-o", "f.csv"},
                 {"branches", "3pfs-g2", "-q", "--independent", "0.4 m, 0.05, 0", "--to-wrench",
                  "0, 0, -10 N, 0, 0, 0", "-o", "f.csv"},
                 {"f.csv"}});
  for (const std::string format : {"csv", "h5"})
    all.push_back({"sweep " + format,
                   {"sweep", "study.yaml", "-q", "--force", "-o", "f." + format},
                   {"sweep", "other.yaml", "-q", "--force", "-o", "f." + format},
                   {"f." + format}});
  all.push_back({"reproduce",
                 {"reproduce", "lsk/fig5", "-o", "f", "-q"},
                 {"reproduce", "lsk/fig5", "-o", "f", "-q"},
                 {"f/lsk/fig5.csv", "f/lsk/fig5.md", "f/lsk/fig5.gp", "f/lsk/fig5.svg", "f/lsk/fig5.png"}});
  return all;
}

void prepare(const fs::path& folder) {
  write_text(folder / "study.yaml", study);
  write_text(folder / "other.yaml", study + "title: another\n");
  write_text(folder / "t.csv", "x[m],y[m]\n0,1\n1,3\n");
}

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    names.insert(fs::relative(entry.path(), folder).string());
  return names;
}

Outcome run_failing(const std::vector<std::string>& words, const fs::path& folder, int at, int reason) {
  std::vector<std::string> all{"/usr/bin/env", std::string("LD_PRELOAD=") + fail_write_path,
                               "SINEW_FAIL_AT=" + std::to_string(at),
                               "SINEW_FAIL_ERRNO=" + std::to_string(reason), command_path};
  all.insert(all.end(), words.begin(), words.end());
  return run_program(all, folder);
}

/// Instead of gnuplot, which takes long to draw: a picture is the checksum of its script. What is looked at
/// here is how the command writes it.
struct QuickGnuplot {
  Scratch folder;
  std::string before = std::getenv("PATH");
  QuickGnuplot() {
    const fs::path program = folder.path() / "gnuplot";
    write_text(program, "#!/bin/sh\nexec cksum\n");
    fs::permissions(program, fs::perms::owner_all);
    setenv("PATH", (folder.path().string() + ":" + before).c_str(), 1);
  }
  QuickGnuplot(const QuickGnuplot&) = delete;
  QuickGnuplot& operator=(const QuickGnuplot&) = delete;
  ~QuickGnuplot() { setenv("PATH", before.c_str(), 1); }
};

void PrintTo(const Writing& writing, std::ostream* stream) { *stream << writing.name; }

class EachWriteFails : public testing::TestWithParam<Writing> {};

TEST_P(EachWriteFails, TheOldFileStaysAndTheReasonIsSaid) {
  if (addresses_are_checked) GTEST_SKIP() << "the sanitizer has to be loaded first";
  const Writing& writing = GetParam();
  const QuickGnuplot gnuplot;
  const Scratch here;
  prepare(here.path());
  const Outcome whole = run_command(writing.words, here.path());
  ASSERT_EQ(whole.exit, 0) << whole.err;
  std::map<std::string, std::string> fresh, old;
  for (const std::string& file : writing.files) {
    fresh[file] = read_text(here.path() / file);
    fs::remove(here.path() / file);
  }
  ASSERT_EQ(run_command(writing.earlier, here.path()).exit, 0);
  for (const std::string& file : writing.files) old[file] = read_text(here.path() / file);
  const auto names = names_in(here.path());
  // The first ten, one of three of those that follow, and the last, which give a file its name.
  const int every = count_of(3, 1);
  int at = 1, last = 0, failed = 0;
  bool is_near_end = false;
  while (true) {
    ASSERT_LT(at, 500);
    const Outcome outcome = run_failing(writing.words, here.path(), at, at % 2 == 0 ? EFBIG : ENOSPC);
    const std::string reason = at % 2 == 0 ? "File too large" : "No space left on device";
    if (outcome.err.find("failed: ") == std::string::npos) {  // it makes fewer writes than that
      EXPECT_EQ(outcome.exit, 0) << outcome.err;
      if (at == last + 1) break;
      at = last + 1;
      is_near_end = true;
      for (const auto& [file, text] : old) write_text(here.path() / file, text);
      continue;
    }
    ++failed;
    last = at;
    at += at < 10 || is_near_end ? 1 : every;
    SCOPED_TRACE(writing.name + ", write " + std::to_string(last) + ": " + outcome.err);
    // HDF5 tries first whether it can write, and a log has checksums: there a failure may be without effect
    const bool may_pass = writing.words.front() == "sweep";
    EXPECT_TRUE(outcome.exit == 4 || (may_pass && outcome.exit == 0)) << outcome.exit;
    EXPECT_TRUE(outcome.exit == 0 || outcome.err.find(reason) != std::string::npos);
    // several results, each whole; or all is written, and what fails is to say so
    const bool is_reproduced =
        writing.name == "reproduce" || outcome.err.find("stdout cannot be written") != std::string::npos;
    for (const std::string& file : writing.files) {
      const std::string now = read_text(here.path() / file);
      EXPECT_TRUE(now == (outcome.exit == 0 ? fresh : old)[file] || (is_reproduced && now == fresh[file]))
          << file;
    }
    for (const char* file : {"f.csv.log", "f.h5.log", "f.h5.part"})
      fs::remove(here.path() / file);  // kept for --resume
    EXPECT_EQ(names_in(here.path()), names);
    for (const auto& [file, text] : old) write_text(here.path() / file, text);
  }
  for (const auto& [file, text] : fresh) EXPECT_EQ(read_text(here.path() / file), text) << file;
  RecordProperty("writes", failed);
  std::cout << writing.name << ": " << failed << " writes failed one by one\n";
}

INSTANTIATE_TEST_SUITE_P(Output, EachWriteFails, testing::ValuesIn(writings()), [](const auto& one) {
  std::string name = one.param.name;
  std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
  return name;
});

TEST(Output, AFullDiscBehindStdoutIsSaidByEveryVerb) {
  const Scratch here;
  prepare(here.path());
  for (const std::string line :
       {"new 3-RFR", "new study", "check 3-rfr", "check 3-rfr --json", "inverse 3-rfr --pose '0, 0, 0'",
        "map 3-rfr --x '0 : 1 mm : 2'", "export nottingham-tpcj --to c-header", "plot 3-rfr -o f.svg",
        "track 3-rfr --from '0, 0, 0' --to '1 mm, 0, 0'", "sweep --list", "sweep study.yaml --list",
        "sweep study.yaml --force -o f.csv", "reproduce --list",
        "diagram nottingham-tpcj --section 0 --changes '-1.1 mm, 2 mm, -0.5 mm'", "completion bash",
        "--version"}) {
    const Outcome outcome = run_shell("sinew " + line + " > /dev/full", here.path());
    EXPECT_EQ(outcome.exit, 4) << line;
    EXPECT_NE(outcome.err.find("stdout cannot be written: No space left on device"), std::string::npos)
        << line;
  }
}

TEST(Output, PlacesThatCannotBeWrittenEndWithTheReason) {
  const Scratch here;
  prepare(here.path());
  fs::create_directory(here.path() / "folder.csv");
  for (const std::string file : {"t.csv/f.csv", "/proc/f.csv", "folder.csv"}) {
    const Outcome outcome =
        run_command({"track", "3-rfr", "--from", "0, 0, 0", "--to", "1 mm, 0, 0", "-o", file}, here.path());
    EXPECT_EQ(outcome.exit, 4) << file;
    EXPECT_NE(outcome.err.find("[file_unwritable]"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find(file), std::string::npos) << outcome.err;
  }
}

TEST(Output, LinksStayPermissionsStayAndDevicesAreWritten) {
  const Scratch here;
  const auto track = [&](const std::string& file) {
    return run_command({"track", "3-rfr", "-q", "--from", "0, 0, 0", "--to", "1 mm, 0, 0", "-o", file},
                       here.path());
  };
  ASSERT_EQ(track("plain.csv").exit, 0);
  const std::string text = read_text(here.path() / "plain.csv");
  fs::create_directory(here.path() / "store");
  write_text(here.path() / "store" / "kept.csv", "old");
  ::chmod((here.path() / "store" / "kept.csv").c_str(), 0640);
  fs::create_symlink("store/kept.csv", here.path() / "link.csv");
  fs::create_symlink("store/new.csv", here.path() / "dangling.csv");
  EXPECT_EQ(track("link.csv").exit, 0);
  EXPECT_EQ(track("dangling.csv").exit, 0);
  EXPECT_TRUE(fs::is_symlink(here.path() / "link.csv") && fs::is_symlink(here.path() / "dangling.csv"));
  EXPECT_EQ(read_text(here.path() / "store" / "kept.csv"), text);
  EXPECT_EQ(read_text(here.path() / "store" / "new.csv"), text);
  struct stat status = {};
  ASSERT_EQ(::stat((here.path() / "store" / "kept.csv").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0640U);
  fs::create_symlink("loop.csv", here.path() / "loop.csv");
  EXPECT_EQ(track("loop.csv").exit, 4);
  EXPECT_EQ(track("/dev/null").exit, 0);
  EXPECT_EQ(track("/dev/stdout").out, text);
  const Outcome piped = run_shell(
      "mkfifo p.csv; { cat p.csv > through.csv & } ; sinew track 3-rfr -q --from '0, 0, 0' --to '1 mm, 0, 0' "
      "-o p.csv; "
      "echo $?; wait; test -p p.csv && echo pipe",
      here.path());
  EXPECT_EQ(piped.out, "0\npipe\n") << piped.err;
  EXPECT_EQ(read_text(here.path() / "through.csv"), text);
  EXPECT_EQ(names_in(here.path() / "store"), (std::set<std::string>{"kept.csv", "new.csv"}));
}

TEST(Output, NoNameOfAFileIsACommand) {
  const Scratch here;
  const std::vector<std::string> names{"|touch hacked #.svg",
                                       "a\nsystem 'touch hacked'\n.svg",
                                       "`touch hacked`.svg",
                                       "$x @y %d {it's} \"q\" \\.svg",
                                       "';system('touch hacked');'.svg",
                                       "#.svg",
                                       "\x1b[31m\x07\xff.svg",
                                       "-o.svg",
                                       "'1|23\"45.svg"};
  for (const std::string& name : names) {
    fs::create_directory(here.path() / "again");
    const Outcome outcome = run_command({"plot", "3-rfr", "--title", name, "-o", name}, here.path());
    EXPECT_EQ(outcome.exit, 0) << name << outcome.err;
    EXPECT_EQ(lines_of(outcome.out).size(), 2U) << outcome.out;
    EXPECT_EQ(outcome.out.find('\x1b'), std::string::npos);
    const std::string script = name.substr(0, name.size() - 3) + "gp";
    EXPECT_TRUE(fs::exists(here.path() / name) && fs::exists(here.path() / script)) << name;
    fs::copy_file(here.path() / script, here.path() / "again" / script);
    const Outcome again =
        run_program({"/usr/bin/env", "gnuplot", "-d", "./" + script}, here.path() / "again");
    EXPECT_EQ(again.exit, 0) << again.err;
    EXPECT_EQ(read_text(here.path() / "again" / name), read_text(here.path() / name)) << name;
    EXPECT_EQ(names_in(here.path() / "again"), (std::set<std::string>{name, script}));
    EXPECT_EQ(names_in(here.path()).count("hacked"), 0U);
    fs::remove_all(here.path() / "again");
  }
}

TEST(Output, AScriptThatWasEditedStays) {
  const Scratch here;
  ASSERT_EQ(run_command({"plot", "3-rfr", "-o", "f.svg"}, here.path()).exit, 0);
  ASSERT_EQ(run_command({"plot", "3-rfr", "-o", "f.svg", "--title", "again"}, here.path()).exit, 0);
  const std::string figure = read_text(here.path() / "f.svg");
  const std::string edited = read_text(here.path() / "f.gp") + "# mine\n";
  write_text(here.path() / "f.gp", edited);
  const Outcome refused = run_command({"plot", "3-rfr", "-o", "f.svg"}, here.path());
  EXPECT_EQ(refused.exit, 2);
  EXPECT_NE(refused.err.find("--force"), std::string::npos) << refused.err;
  EXPECT_NE(refused.err.find("[script_edited]"), std::string::npos) << refused.err;
  EXPECT_EQ(read_text(here.path() / "f.gp"), edited);
  EXPECT_EQ(read_text(here.path() / "f.svg"), figure);
  EXPECT_EQ(run_command({"plot", "3-rfr", "-o", "f.svg", "--force"}, here.path()).exit, 0);
  EXPECT_NE(read_text(here.path() / "f.gp"), edited);
}

TEST(Output, ASweepReplacesNoResultsByItself) {
  const Scratch here;
  prepare(here.path());
  for (const std::string format : {"csv", "h5"}) {
    const std::string file = "f." + format;
    const auto sweep = [&](const std::string& from, std::vector<std::string> more) {
      more.insert(more.begin(), {"sweep", from, "-q", "-o", file});
      return run_command(more, here.path());
    };
    ASSERT_EQ(sweep("study.yaml", {}).exit, 0);
    const std::string text = read_text(here.path() / file);
    const auto inode = [&] {
      struct stat status = {};
      ::stat((here.path() / file).c_str(), &status);
      return status.st_ino;
    };
    const auto before = inode();
    const Outcome same = sweep("study.yaml", {}), other = sweep("other.yaml", {}),
                  resumed = sweep("other.yaml", {"--resume"});
    for (const Outcome* outcome : {&same, &other, &resumed}) {
      EXPECT_EQ(outcome->exit, 2);
      EXPECT_NE(outcome->err.find("[result_exists]"), std::string::npos) << outcome->err;
    }
    EXPECT_EQ(sweep("study.yaml", {"--resume"}).exit, 0);
    EXPECT_EQ(inode(), before) << "nothing was written";
    EXPECT_EQ(read_text(here.path() / file), text);
    EXPECT_EQ(sweep("other.yaml", {"--force"}).exit, 0);
    EXPECT_NE(read_text(here.path() / file), text);
    EXPECT_EQ(names_in(here.path()).count(file + ".log"), 0U);
  }
}

TEST(Output, TextsOfFilesReachNoTerminalRaw) {
  const Scratch here;
  const std::string evil =
      "\x1b]0;x\x07\xc2\x9b"
      "31m\xe2\x80\xaetxt";  // ESC, BEL, CSI of C1, right to left
  write_text(here.path() / "t.csv", "a" + evil + ",b\n0,1\n1,2\n");
  write_text(here.path() / (evil + ".yaml"), "sinew: 1\nrobot: x\n");
  write_text(here.path() / "robot.yaml", [&] {
    std::string text = run_command({"new", "3-RFR"}, here.path()).out;
    const std::size_t at = text.find("\nname:");
    return text.replace(at + 1, text.find('\n', at + 1) - at - 1,
                        "name: \"a\\nconverged in 4 iterations \\e[31m \\u202E \\x9b \\a\"");
  }());
  std::vector<Outcome> outcomes{
      run_command({"plot", "t.csv", "--y", "none", "-o", "f.svg"}, here.path()),
      run_command({"plot", "t.csv", "--y", evil, "-o", "f.svg"}, here.path()),
      run_command({"plot", "t.csv", "-o", evil + ".svg"}, here.path()),
      run_command({evil}, here.path()),
      run_command({"new", evil}, here.path()),
      run_command({"check", evil + ".yaml"}, here.path()),
      run_command({"check", "robot.yaml"}, here.path()),
      run_command({"check", "robot.yaml", "--json"}, here.path()),
      run_command({"inverse", "robot.yaml", "--pose", "0, 0, 0"}, here.path()),
      run_command({"inverse", "robot.yaml", "--pose", "9 m, 0, 0"}, here.path()),
      run_command({"inverse", "robot.yaml", "--set", evil + "=1", "--pose", "0, 0, 0"}, here.path()),
      run_command({"sweep", evil}, here.path()),
      run_command({"map", "robot.yaml", "--x", "0 : 1 mm : 2"}, here.path()),
      run_command({"reproduce", evil}, here.path()),
  };
  for (const Outcome& outcome : outcomes)
    for (const std::string& text : {outcome.out, outcome.err}) {
      for (const char* raw : {"\x1b", "\x07", "\xc2\x9b", "\xe2\x80\xae"})
        EXPECT_EQ(text.find(raw), std::string::npos) << text;
      for (const std::string& line : lines_of(text))
        EXPECT_FALSE(line.starts_with("converged in 4 iterations \\u")) << text;
    }
}

TEST(Output, FiguresLeaveOutWhatDidNotConvergeAndSaySo) {
  const Scratch here;
  write_text(here.path() / "t.csv",
             "# status: 0 unreachable, 6 unstable, 7 converged\nx[m],y[m],v,status\n"
             "0,0,1,7\n1,0,2,6\n0,1,3,7\n1,1,,0\n");
  const auto script = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"plot", "t.csv", "-o", "f.svg"});
    const Outcome outcome = run_command(more, here.path());
    EXPECT_EQ(outcome.exit, 0) << outcome.err;
    return read_text(here.path() / "f.gp");
  };
  const std::string plain = script({});
  EXPECT_NE(plain.find("$panel1_map << EOD\n0 0 1\n0 1000 3\nEOD"), std::string::npos) << plain;
  EXPECT_NE(plain.find("2 of 4 samples converged; not drawn: 1 unreachable, 1 unstable"), std::string::npos);
  const std::string all = script({"--all-statuses"});
  EXPECT_NE(all.find("$panel1_map << EOD\n0 0 1\n1000 0 2\n0 1000 3\nEOD"), std::string::npos);
  EXPECT_NE(all.find("also drawn: 1 unreachable, 1 unstable"), std::string::npos);
  const std::string statuses = script({"--value", "status"});
  EXPECT_NE(statuses.find("set cbtics ('unreachable' 0, 'unstable' 1, 'converged' 2)"), std::string::npos);
  EXPECT_NE(statuses.find("$panel1_map << EOD\n0 0 2\n1000 0 1\n0 1000 2\n1000 1000 0\nEOD"),
            std::string::npos);
  EXPECT_NE(script({"--as", "points", "--x", "x", "--y", "y", "--colour", "status"}).find("'unstable' 1"),
            std::string::npos);
  EXPECT_NE(script({"--as", "line", "--x", "x", "--y", "status"}).find("set ytics ('unreachable' 0"),
            std::string::npos);
  // a column of that name that has no words is one like any other
  write_text(here.path() / "t.csv", "x[m],y[m],v,status\n0,0,1,7\n1,0,2,6\n0,1,3,7\n1,1,4,0\n");
  EXPECT_NE(script({}).find("1000 0 2"), std::string::npos);
}

}  // namespace output_test
