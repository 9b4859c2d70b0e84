/// @file verbs.hpp
/// The verbs of the command, written down once: the parser, the help and the completion all read these
/// tables.
#pragma once
#include <initializer_list>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "query/kinds.hpp"

namespace sinew::cli {

/// A command line taken apart: texts as they were written.
struct Arguments {
  std::string_view verb;
  std::vector<std::string> operands;
  std::map<std::string, std::vector<std::string>, std::less<>>
      options;  ///< by name without dashes; a flag has no text

  bool has(std::string_view option) const { return options.find(option) != options.end(); }
  /// The text of an option, or null.
  const std::string* text(std::string_view option) const {
    const auto found = options.find(option);
    return found == options.end() || found->second.empty() ? nullptr : &found->second.front();
  }
  std::string operand() const { return operands.empty() ? std::string() : operands.front(); }
};

struct Option {
  std::string_view name;   ///< without dashes
  std::string_view value;  ///< what follows it; empty: nothing, it is a flag
  std::string_view help;
  char letter = 0;  ///< short form, if there is one
  bool repeats = false;
  std::span<const std::string_view> words = {};  ///< that its value may be; none: it may be anything
  bool takes_list = false;                       ///< of them, with commas between
};

struct Verb {
  std::string_view name;
  std::string_view operand;  ///< `ROBOT`, or two of them; in brackets where it may be left out
  std::string_view summary;
  std::vector<std::string_view> options;
  std::vector<std::string_view> needs;  ///< at least one of these options
  std::string_view notes;
  std::string_view example;  ///< works as it stands; the tests run it
  int (*run)(const Arguments&);
};

std::span<const Verb> verbs();
const Verb* find_verb(std::string_view name);
const Option& option(std::string_view name);
std::span<const Option> all_options();
/// Options that are fields of a kind of question, and others.
/// @param without fields that the verb does not take, or spells otherwise
std::vector<std::string_view> options_of(Ask ask, std::initializer_list<std::string_view> without,
                                         std::initializer_list<std::string_view> with);

/// @name Texts
/// @{
std::vector<std::string_view> study_names();  ///< papers and their items
std::string help();
std::string help(const Verb& verb);
std::string help_units();
std::string help_fields();                   ///< of questions
std::string fields_json();                   ///< the same for what is made of them
std::vector<std::string_view> kind_names();  ///< what `new` makes
std::vector<std::string> unit_advice();      ///< a line for each kind of quantity
std::string manual();                        ///< a page for man, of all verbs and options
/// @}

/// @name What the verbs do; the answer is the exit code
/// @{
int run_question(const Arguments& arguments);  ///< forward, inverse, analyse
int run_diagram(const Arguments& arguments);
int run_track(const Arguments& arguments);
int run_branches(const Arguments& arguments);
int run_map(const Arguments& arguments);
int run_sweep(const Arguments& arguments);
int run_query(const Arguments& arguments);
int run_check(const Arguments& arguments);
int check_study(const Arguments& arguments);  ///< of check, what is no robot
int check_scene(const Arguments& arguments);
int run_export(const Arguments& arguments);
int run_serve(const Arguments& arguments);
int run_new(const Arguments& arguments);
int new_study(const Arguments& arguments);  ///< of new, a study
int run_scene(const Arguments& arguments);
int run_plan(const Arguments& arguments);
int run_drive(const Arguments& arguments);
int run_identify(const Arguments& arguments);
int run_list(const Arguments& arguments);
int run_reproduce(const Arguments& arguments);
int run_plot(const Arguments& arguments);
int run_completion(const Arguments& arguments);
int run_help(const Arguments& arguments);
/// @}

}  // namespace sinew::cli
