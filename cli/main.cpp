/// The command line: taken apart here, by the tables of verbs.hpp, and handed to a verb.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstring>
#include <exception>

#include "sinew/io/node.hpp"
#include "terminal.hpp"
#include "verbs.hpp"

namespace sinew::cli {
namespace {

int usage(std::string_view verb, std::string_view code, std::string_view text) {
  message(fmt::format("sinew{}{}: {} [{}]", verb.empty() ? "" : " ", verb, text, code), Style::bad);
  return bad_input;
}

std::string maybe(std::string_view word, const std::vector<std::string_view>& known,
                  std::string_view dashes = {}) {
  const std::string_view hint = closest(word, known);
  return hint.empty() ? std::string() : fmt::format("; did you mean {}{}?", dashes, hint);
}

int unknown_verb(std::string_view word) {
  std::vector<std::string_view> names;
  for (const Verb& verb : verbs()) names.push_back(verb.name);
  if (word.starts_with('-')) {
    const std::string_view bare = word.substr(std::min(word.find_first_not_of('-'), word.size()));
    const std::string hint =
        bare == "v" ? "; did you mean --version?" : maybe(bare, {"version", "help"}, "--");
    return usage(
        "", "unknown_option",
        fmt::format("unknown option {}{}", in_quotes(word),
                    !hint.empty() ? hint : "; write a verb first, then its options: sinew forward --help"));
  }
  names.push_back("version");
  return usage("", "unknown_verb",
               fmt::format("unknown verb {}{} Verbs: {}.", in_quotes(word),
                           maybe(word, names).empty() ? "." : maybe(word, names),
                           fmt::join(names.begin(), names.end() - 1, ", ")));
}

int refuse_option(const Verb& verb, const std::string& word) {
  const std::size_t begin = std::min(word.find_first_not_of('-'), word.size());
  const std::string hint = maybe(word.substr(begin, word.find('=') - begin), verb.options, "--");
  return usage(verb.name, "unknown_option",
               fmt::format("unknown option {}{} See sinew {} --help.", in_quotes(word),
                           hint.empty() ? "." : hint, verb.name));
}

int refuse_operand(const Verb& verb, const std::string& word) {
  return usage(verb.name, "unexpected_argument",
               fmt::format("{} is one argument too many; a value with blanks or commas goes in quotes: {}",
                           in_quotes(word), verb.example));
}

int refuse_missing(const Verb& verb) {
  return usage(verb.name, "missing_option",
               fmt::format("--{} is missing. Example: {}", fmt::join(verb.needs, " or --"), verb.example));
}

/// CLI11's own complaints are about options without their value.
int refuse_parse(const Verb& verb, const CLI::ParseError& error) {
  const std::string_view text = error.what();
  for (const std::string_view name : verb.options)
    if (text.find(fmt::format("--{}", name)) != std::string_view::npos && !option(name).value.empty())
      return usage(verb.name, "missing_value",
                   fmt::format("--{} needs a value: --{} {}. Example: {}", name, name, option(name).value,
                               verb.example));
  return usage(verb.name, "bad_option", fmt::format("{}. See sinew {} --help.", text, verb.name));
}

void declare(CLI::App& app, const Verb& verb, Arguments& arguments) {
  app.set_help_flag();
  app.allow_extras();
  app.add_option("operand", arguments.operands);
  for (const std::string_view name : verb.options) {
    const Option& known = option(name);
    auto& texts = arguments.options[std::string(name)];
    const std::string spelling =
        (known.letter ? fmt::format("-{},", known.letter) : "") + fmt::format("--{}", name);
    if (known.value.empty())
      app.add_flag(spelling);
    else  // a value of its own may begin with a minus: CLI11 takes one value whatever it looks like
      app.add_option(spelling, texts)->allow_extra_args(false);
  }
}

int run(const Verb& verb, std::vector<std::string> words) {
  CLI::App app;
  Arguments arguments{verb.name, {}, {}};
  declare(app, verb, arguments);
  std::ranges::reverse(words);  // CLI11 takes them from the back
  try {
    app.parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    return refuse_parse(verb, error);
  }
  std::erase_if(arguments.options, [&](const auto& entry) { return app.count("--" + entry.first) == 0; });
  if (arguments.has("help")) {
    print(help(verb));
    return solved;
  }
  if (const auto rest = app.remaining(); !rest.empty()) return refuse_option(verb, rest.front());
  const auto most =
      static_cast<std::size_t>(1 + std::ranges::count(verb.operand, ' '));  // `ROBOT ROWS` are two
  if (arguments.operands.size() > most) return refuse_operand(verb, arguments.operands[most]);
  for (const auto& [name, texts] : arguments.options)
    if (texts.size() > 1 && !option(name).repeats)
      return usage(verb.name, "duplicate_option",
                   fmt::format("--{} is given {} times; keep one.", name, texts.size()));
  if (verb.operand.starts_with("ROBOT") && arguments.operands.empty())
    return usage(
        verb.name, "missing_robot",
        fmt::format("which robot? Give a robot file or the name of a built-in robot: {}", verb.example));
  const auto is_given = [&](std::string_view name) { return arguments.has(name); };
  if (!verb.needs.empty() && std::ranges::none_of(verb.needs, is_given)) return refuse_missing(verb);
  return verb.run(arguments);
}

int run(std::vector<std::string> words) {
  if (words.empty()) {
    message(help());
    return bad_input;
  }
  const std::string first = words.front();
  if (first == "--version" || first == "-V" || first == "version") {
    print(fmt::format("sinew {}\n", version()));
    return solved;
  }
  if (first == "--help" || first == "-h") {
    print(help());
    return solved;
  }
  const Verb* verb = find_verb(first);
  if (!verb) return unknown_verb(first);
  words.erase(words.begin());
  return run(*verb, std::move(words));
}

}  // namespace
}  // namespace sinew::cli

int main(int argc, char** argv) {
  using namespace sinew::cli;
  watch_signals();
  try {
    return run(std::vector<std::string>(argv + 1, argv + argc));
  } catch (const OutputLost& lost) {
    if (lost.code == EPIPE) return stopped;  // nobody reads any more, as in `| head`
    message(fmt::format("sinew: stdout cannot be written: {}", std::strerror(lost.code)));
    return stopped;
  } catch (const std::exception& error) {
    message(
        fmt::format("sinew: internal error: {}; please report it with the command line and the robot file.",
                    error.what()));
  }
  return internal_error;
}
