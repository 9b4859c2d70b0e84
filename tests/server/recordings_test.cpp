/// Recordings as the server lists and gives them, of a folder in which anything may be.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

// It has httplib: last.
#include "desk.hpp"

namespace sinew::server {
namespace recordings_test {

namespace fs = std::filesystem;

const std::string head =
    "# sinew recording, version 1\n# robot: arm\n# table: 0000ABCD\n# model: lsk\n"
    "# date: 2026-01-02T03:04:05+0000\n# file:\n#   name: arm\n";
const std::string columns = "time[s],S0_beta_1[rad],S0_state,S1_state,event,text\n";

struct Place {
  Place() : folder(fs::temp_directory_path() / "sinew-recordings-test") {
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  ~Place() {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  }
  void write(const std::string& name, const std::string& text) { std::ofstream(folder / name) << text; }
  Options options() const {
    Options chosen;
    chosen.device.folder = folder.string();
    return chosen;
  }
  fs::path folder;
};

std::string code_of(const std::string& answer) {
  const json told = json::parse(answer, nullptr, false);
  return told.is_object() && told.contains("error") ? told["error"]["code"].get<std::string>() : "";
}

TEST(Recordings, AreListedTheNewestFirst) {
  Place place;
  place.write("2026-01-02-a.csv", head + columns +
                                      "0.000,0,EXACT,EXACT,,\n0.020,0.1,SLACK,EXACT,,\n"
                                      "0.030,0.1,SLACK,EXACT,snapshot,\"a, OVER-TENSIONED\"\n"
                                      "0.040,0.1,PARTLY SLACK,EXACT,,\n1.5,0.1,EXA");
  place.write("2026-01-03-b.csv", head + columns);
  Desk desk(place.options());
  const json list = json::parse(desk.get("/api/recordings"));
  ASSERT_EQ(list["recordings"].size(), 2u) << list;
  EXPECT_EQ(list["left_out"], 0);
  const json& first = list["recordings"][0];
  EXPECT_EQ(first["name"], "2026-01-03-b");
  EXPECT_EQ(first["rows"], 0);
  EXPECT_TRUE(first["worst"].is_null());
  const json& second = list["recordings"][1];
  EXPECT_EQ(second["robot"], "arm");
  EXPECT_EQ(second["table"], "0000ABCD");
  EXPECT_EQ(second["start"], "2026-01-02T03:04:05+0000");
  EXPECT_EQ(second["rows"], 3) << "that are whole";
  EXPECT_EQ(second["duration"], 0.04);
  EXPECT_EQ(second["worst"], "SLACK") << "of states, not of what texts say";
  EXPECT_EQ(second["snapshots"], 1);
  place.write("2026-01-02-a.csv", head + columns + "0.000,0,EXACT,OVER-TENSIONED,,\n");
  EXPECT_EQ(json::parse(desk.get("/api/recordings"))["recordings"][1]["worst"], "OVER-TENSIONED")
      << "changed";
}

TEST(Recordings, WithoutAFolderThereAreNone) {
  Options options;
  options.device.folder = "/nowhere/at/all";
  Desk desk(options);
  EXPECT_EQ(desk.get("/api/recordings"), R"({"recordings":[],"left_out":0})");
  EXPECT_EQ(code_of(desk.get("/api/recordings/a")), "unknown_recording");
}

TEST(Recordings, OnlyPlainFilesOfThisFormAreThere) {
  Place place;
  place.write("good.csv", head + columns);
  place.write("other.csv", "time,value\n1,2\n");
  place.write("empty.csv", "");
  place.write(".hidden.csv", head + columns);
  place.write("a b.csv", head + columns);
  place.write("robot.yaml", head);
  fs::create_directories(place.folder / "folder.csv");
  const fs::path outside = fs::temp_directory_path() / "sinew-recordings-outside.csv";
  std::ofstream(outside) << head << columns;
  fs::create_symlink(outside, place.folder / "link.csv");
  fs::create_symlink(outside, place.folder / "good-001.jpg");
  ASSERT_EQ(::mkfifo((place.folder / "pipe.csv").c_str(), 0600), 0);
  Desk desk(place.options());
  const json list = json::parse(desk.get("/api/recordings"));
  ASSERT_EQ(list["recordings"].size(), 1u) << list;
  EXPECT_EQ(desk.get("/api/recordings/good"), head + columns);
  for (const char* name :
       {"other", "empty", ".hidden", "a%20b", "folder", "link", "pipe", "robot", "..", "%2e%2e", "good.csv",
        "..%2fsinew-recordings-test%2fgood", "%00", "good%00", "good%0a", "", "*"}) {
    const std::string answer = desk.get(std::string("/api/recordings/") + name);
    EXPECT_EQ(desk.status, 404) << name << answer.substr(0, 100);
  }
  desk.get("/api/recordings/" + std::string(5000, 'a'));
  EXPECT_EQ(desk.status, 404);
  EXPECT_EQ(code_of(desk.get("/api/recordings/good/snapshots/001")), "unknown_snapshot") << "a link";
  fs::remove(outside);
}

TEST(Recordings, DecimatedKeepEventsAndChangesOfState) {
  Place place;
  std::string text = head + columns;
  for (int i = 0; i < 100; ++i)
    text += std::to_string(i) + ",0," + (i == 33 || i == 34 ? "SLACK" : "EXACT") + ",EXACT,,\n" +
            (i == 50 ? "50,0,EXACT,EXACT,info,\"held\"\n" : "");
  place.write("a.csv", text);
  Desk desk(place.options());
  EXPECT_EQ(desk.get("/api/recordings/a"), text);
  EXPECT_EQ(desk.get("/api/recordings/a?every=1"), text);
  const std::string few = desk.get("/api/recordings/a?every=40");
  EXPECT_EQ(few, head + columns +
                     "0,0,EXACT,EXACT,,\n33,0,SLACK,EXACT,,\n35,0,EXACT,EXACT,,\n40,0,EXACT,EXACT,,\n"
                     "50,0,EXACT,EXACT,info,\"held\"\n80,0,EXACT,EXACT,,\n");
  for (const char* every : {"0", "-1", "x", "", "1.5", "99999999999999", "2%20"}) {
    desk.get(std::string("/api/recordings/a?every=") + every);
    EXPECT_EQ(desk.status, 400) << every;
  }
}

TEST(Recordings, TooLargeOnesAreAskedByFewerRows) {
  Place place;
  std::string text = head + columns;
  for (int i = 0; i < 3000; ++i) text += std::to_string(i) + ",0.123456789,EXACT,EXACT,,\n";
  place.write("a.csv", text);
  Options options = place.options();
  options.limits.answers = 20'000;
  Desk desk(options);
  const json refused = json::parse(desk.get("/api/recordings/a"));
  EXPECT_EQ(desk.status, 413);
  const std::string message = refused["error"]["message"];
  const auto every = message.find("?every=");
  ASSERT_NE(every, std::string::npos) << message;
  const std::string fewer = desk.get("/api/recordings/a" + message.substr(every));
  EXPECT_EQ(desk.status, 200);
  EXPECT_LT(fewer.size(), 20'000u);
}

TEST(Recordings, DamagedOnesAreGivenAsTheyAre) {
  Place place;
  const std::string damaged = head + columns + "0,0,EXACT\n\n\"\n,,,,,,,,,\n1,0,EXACT,EXACT,,\n" +
                              std::string("\0\xFF", 2) + "\nno newline";
  place.write("a.csv", damaged);
  place.write("b.csv", "# sinew recording, version 1");
  place.write("c.csv", "# sinew recording, version 99\n# robot: \xFF\xFE\n");
  Desk desk(place.options());
  EXPECT_EQ(desk.get("/api/recordings/a"), damaged);
  const json list = json::parse(desk.get("/api/recordings"));
  ASSERT_EQ(list["recordings"].size(), 3u) << list;
  EXPECT_EQ(list["recordings"][0]["version"], 99);
  EXPECT_EQ(list["recordings"][2]["rows"], 1);
}

TEST(Recordings, SnapshotsAreGivenByNumber) {
  Place place;
  place.write("a.csv", head + columns);
  place.write("a-001.jpg", "jpeg");
  place.write("a-002.png", std::string("p\0ng", 4));
  Desk desk(place.options());
  EXPECT_EQ(desk.get("/api/recordings/a/snapshots/001"), "jpeg");
  EXPECT_EQ(desk.get("/api/recordings/a/snapshots/002"), std::string("p\0ng", 4));
  for (const char* number : {"003", "1", "0001", "..", "00x", "%2e"}) {
    desk.get(std::string("/api/recordings/a/snapshots/") + number);
    EXPECT_EQ(desk.status, 404) << number;
  }
}

TEST(Recordings, ASnapshotNeedsADevice) {
  Desk desk;
  EXPECT_EQ(code_of(desk.post("/api/device/snapshot?text=x", "\xFF\xD8\xFF", "image/jpeg")), "no_device");
  desk.post("/api/device/snapshot", "{}");
  EXPECT_EQ(desk.status, 415);
  desk.post("/api/device/snapshot", std::string((std::size_t{8} << 20U) + 1, 'x'), "image/png");
  EXPECT_EQ(desk.status, 413);
}

}  // namespace recordings_test
}  // namespace sinew::server
