/// The page for man: troff, made of the tables of verbs and of the library's units.
#include <fmt/format.h>

#include <array>

#include "sinew/io/node.hpp"
#include "sinew/io/robot_file.hpp"
#include "verbs.hpp"

namespace sinew::cli {
namespace {

/// A character of UTF-8 at the beginning of a text, and its bytes.
std::pair<unsigned, std::size_t> code_point(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text.front());
  const std::size_t size = lead < 0x80 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
  unsigned code = lead & (size == 1 ? 0x7FU : size == 2 ? 0x1FU : size == 3 ? 0x0FU : 0x07U);
  for (std::size_t i = 1; i < size && i < text.size(); ++i)
    code = code << 6U | (static_cast<unsigned char>(text[i]) & 0x3FU);
  return {code, std::min(size, text.size())};
}

/// As troff takes it: ASCII, and nothing that it takes for a request.
std::string troff(std::string_view text) {
  std::string result;
  bool is_line_begin = true;
  while (!text.empty()) {
    const auto [code, size] = code_point(text);
    const char c = text.front();
    if (is_line_begin && (c == '.' || c == '\'')) result += "\\&";
    if (code >= 0x80)
      result += fmt::format("\\[u{:04X}]", code);
    else if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else if (c == '\'')
      result += "\\(aq";
    else if (c == '^')
      result += "\\(ha";
    else if (c == '~')
      result += "\\(ti";
    else
      result += c;
    is_line_begin = c == '\n';
    text.remove_prefix(size);
  }
  return result;
}

std::string bold(std::string_view text) { return "\\fB" + troff(text) + "\\fR"; }
std::string italic(std::string_view text) { return text.empty() ? "" : "\\fI" + troff(text) + "\\fR"; }

std::string example(std::string_view lines) { return ".EX\n" + troff(lines) + ".EE\n"; }

/// Prose, in which lines that begin with blanks are examples.
std::string paragraphs(std::string_view text) {
  std::string result, lines;
  const auto end_example = [&] {
    if (!lines.empty()) result += example(lines);
    lines.clear();
  };
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    if (line.starts_with("  ")) {
      lines += std::string(line) + '\n';
    } else if (!line.empty()) {
      end_example();
      result += troff(line) + '\n';
    }
    text.remove_prefix(std::min(line.size() + 1, text.size()));
  }
  end_example();
  return result;
}

std::string section_of(const Verb& verb) {
  std::string names;
  for (const std::string_view name : verb.options)
    names += fmt::format("{}\\fB\\-\\-{}\\fR", names.empty() ? "" : ", ", troff(name));
  return fmt::format(".SS {} {}\n{}.\n{}.PP\nOptions: {}.\n.PP\nExample:\n{}", bold(verb.name),
                     italic(verb.operand), troff(verb.summary),
                     verb.notes.empty() ? "" : ".PP\n" + paragraphs(verb.notes), names,
                     example(fmt::format("  {}\n", verb.example)));
}

/// Every option that a verb has, once, as the table of options has them.
std::string options_of_all() {
  std::string text;
  for (const Option& known : all_options())
    text +=
        fmt::format(".TP\n{}{} {}\n{}.\n", known.letter ? bold(fmt::format("-{}", known.letter)) + ", " : "",
                    bold(fmt::format("--{}", known.name)), italic(known.value), troff(known.help));
  return text;
}

struct Entry {
  std::string_view name, text;
};
constexpr std::array exits{Entry{"0", "solved"}, Entry{"1", "internal error"}, Entry{"2", "bad input"},
                           Entry{"3", "no solution, or an unstable one; said why"},
                           Entry{"4", "stopped by a limit or a signal, or the answer cannot be written"}};
constexpr std::array variables{
    Entry{"NO_COLOR", "where it is not empty, terminals see no colours; nor where TERM is dumb"},
    Entry{"COLUMNS", "the width of tables of words on a terminal; default the terminal's"}};

template <class List>
std::string tagged(const List& list) {
  std::string text;
  for (const Entry& entry : list) text += fmt::format(".TP\n{}\n{}.\n", bold(entry.name), troff(entry.text));
  return text;
}

}  // namespace

std::string manual() {
  std::string verb_sections, units;
  for (const Verb& verb : verbs()) verb_sections += section_of(verb);
  for (const std::string& line : unit_advice()) units += troff("  " + line) + '\n';
  return fmt::format(
      ".\\\" Made by sinew help \\-\\-man of the command's own tables.\n"
      ".TH SINEW 1 \"\" \"sinew {}\" \"User Commands\"\n"
      ".SH NAME\nsinew \\- kinematics and singularities of continuum robots\n"
      ".SH SYNOPSIS\n\\fBsinew\\fR \\fIVERB\\fR [\\fIROBOT\\fR] [\\fIOPTIONS\\fR]\n"
      ".SH DESCRIPTION\n\\fIROBOT\\fR is a robot file or the name of a built\\-in robot: {}.\n"
      ".PP\nNumbers are SI and radians; with a unit they may be anything else: \"10 mm\", \"5 deg\".\n"
      "Tables show mm and degrees, \\fB\\-\\-json\\fR shows SI and radians.\n"
      "Answers are on stdout, messages on stderr.\n"
      "Ctrl\\-C stops a solve, which answers what it has; a second one ends the command at once.\n"
      ".SH VERBS\n{}.SH OPTIONS\n{}.SH UNITS\n.EX\n{}.EE\n.SH EXIT STATUS\n{}.SH ENVIRONMENT\n{}",
      version(), troff(fmt::format("{}", fmt::join(builtin_robot_names(), ", "))), verb_sections,
      options_of_all(), units, tagged(exits), tagged(variables));
}

}  // namespace sinew::cli
