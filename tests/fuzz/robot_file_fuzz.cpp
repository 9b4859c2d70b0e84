// Robot files: read, and where they say a robot, described and asked for its home.
#include <span>

#include "check.hpp"
#include "driver.hpp"
#include "sinew/session.hpp"

namespace {

constexpr std::string_view words[] = {"sinew: 1\n",
                                      "name: a\n",
                                      "kind: serial\n",
                                      "space: planar\n",
                                      "space: spatial\n",
                                      "architecture: 3-RFR\n",
                                      "platform: ",
                                      "home: ",
                                      "radius: ",
                                      "mass: 1\n",
                                      "center: ",
                                      "defaults:\n",
                                      "legs:\n",
                                      "  - ",
                                      "link: ",
                                      "closure: ",
                                      "base: ",
                                      "point: ",
                                      "direction: ",
                                      "type: arc",
                                      "type: rod",
                                      "type: strut",
                                      "type: chord",
                                      "type: pin",
                                      "type: clamp",
                                      "type: ball",
                                      "type: rail",
                                      "length: ",
                                      "tendon_offset: ",
                                      "joints: ",
                                      "material: ",
                                      "E: ",
                                      "diameter: ",
                                      "section: {width: 1 mm, height: 2 mm}",
                                      "actuated: [tendon_1]",
                                      "actuated: [length]",
                                      "tied: 0",
                                      "shared: true",
                                      "spin: held",
                                      "first_axis: ",
                                      "hinge_axis: ",
                                      "gravity: [0, 0, -9.81]",
                                      "measurement: ",
                                      "drive: {toe: 1 mm}",
                                      "marker: {place: [0, 0, 1 mm]}",
                                      "end: {bending: 1}",
                                      "taper: round",
                                      "sections: ",
                                      "count: ",
                                      "segments: ",
                                      "joint: ",
                                      "disc: ",
                                      "height: ",
                                      "tendons: ",
                                      "angle: ",
                                      "limit: ",
                                      "extension: ",
                                      "motor: ",
                                      "lead: ",
                                      "counts: ",
                                      "stretch: ",
                                      "stiffness: ",
                                      "tolerance: ",
                                      "type: elastic",
                                      "backbone: ",
                                      "discs: ",
                                      "guides: channel",
                                      "through: ",
                                      "turn: ",
                                      "end_radius: ",
                                      "end_diameter: ",
                                      "bending: ",
                                      "torsion: ",
                                      "precurvature: ",
                                      "compliance: ",
                                      "pretension: ",
                                      "tip: ",
                                      "law: cosserat",
                                      "~",
                                      "[]",
                                      "{}",
                                      "null",
                                      "true",
                                      "180 deg",
                                      "10 mm",
                                      "5 kg",
                                      "1e999",
                                      "&a ",
                                      "*a",
                                      "!t ",
                                      "---\n",
                                      "\t",
                                      "<<: "};

/// A name where a file may stand is not followed: parse_yaml reads one text.
void ask(sinew::Session& session, const std::string& query) {
  sinew::fuzz::check_answer(session.answer(query));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  auto document = sinew::parse_yaml({reinterpret_cast<const char*>(data), size}, "robot.yaml");
  if (!document) return sinew::fuzz::check_errors(document.error()), 0;
  auto session = sinew::Session::open(std::move(*document));
  if (!session) return sinew::fuzz::check_errors(session.error()), 0;
  ask(*session, R"({"query": "describe"})");
  const auto about = nlohmann::json::parse(session->answer(R"({"query": "describe"})"));
  const std::string kind = about.value("kind", "");
  if (kind == "arm") return 0;
  const bool is_serial = kind == "serial";
  const std::string home = is_serial ? R"("configuration": [])" : R"("pose": )" + about["home"].dump();
  for (const char* query : {"inverse", "velocity", "shape"})
    ask(*session, std::string(R"({"query": ")") + query + R"(", "max_iterations": 50, )" + home + "}");
  if (is_serial) ask(*session, R"({"query": "forward", "configuration": [[0.1, 0.2]]})");
  return 0;
}

SINEW_FUZZ_MAIN("robot_file", words)
