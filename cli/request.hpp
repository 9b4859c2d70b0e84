/// @file request.hpp
/// The robot of a command line, and its options as the query that asks the same.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "answer.hpp"
#include "verbs.hpp"

namespace sinew::cli {

struct Input {
  std::string name, unit;  ///< `legs[0].tendon_1`; SI
};

/// A robot and what the spelling of options and the headings of tables depend on.
struct OpenRobot {
  Session session;
  Answer description;  ///< answer to `describe`
  std::vector<Input> inputs;
  bool is_spatial;
  bool is_on_rods;  ///< its legs bear load
  bool is_quiet;    ///< says nothing while it solves

  /// The SI unit of all inputs; empty where they differ.
  std::string input_unit() const;
};
/// The robot that the command line names, as `--set` and `--theta-is` change it.
Expected<OpenRobot> open(const Arguments& arguments);
/// The same; an error where that is a serial robot or an arm.
Expected<OpenRobot> open_with_platform(const Arguments& arguments);

/// What puts a query at the robot's home: its `pose`, of a serial robot `configuration`, of a robot on rods
/// its `independent` coordinates.
Member at_home(const OpenRobot& robot);

/// Without the blanks around it.
std::string_view trimmed(std::string_view text);

/// What `--set` changes of the robot, `{path: value}`.
Expected<std::vector<Member>> settings(const Arguments& arguments);

/// A whole number that an option gives, within bounds; `otherwise` without it, and after an error.
int whole_option(const Arguments& arguments, std::string_view name, int least, int most, int otherwise,
                 Errors& errors);

/// The query that the options of a verb stand for (`--pose "10 mm, 0, 5 deg"`, `--set path=value`, ...). A
/// tree, which no limit of texts binds: the path of a file may be long.
Expected<Document> request(std::string_view query, const Arguments& arguments, const OpenRobot& robot);
/// Puts it; the answer may be an error.
Answer ask(OpenRobot& robot, const Document& query);

}  // namespace sinew::cli
