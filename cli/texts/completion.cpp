/// completion: lines of this command completed by a shell, made of the tables of verbs.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "sinew/io/node.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/study/study.hpp"
#include "terminal.hpp"
#include "verbs.hpp"

namespace sinew::cli {
namespace {

using Names = std::vector<std::string_view>;

Names verb_names() {
  Names names;
  for (const Verb& verb : verbs()) names.push_back(verb.name);
  return names;
}

/// Words that operands are made of, which the scripts have as variables.
struct Set {
  std::string_view name;
  std::string_view of;  ///< part of what a verb's table calls its operand
  Names (*words)();
};
constexpr std::array sets{Set{"verbs", "VERB", verb_names}, Set{"robots", "ROBOT", builtin_robot_names},
                          Set{"studies", "STUDY", builtin_study_names}, Set{"figures", "PAPER", study_names},
                          Set{"kinds", "KIND", kind_names}};

/// What may stand behind a verb: words of sets, words of its own, files of these endings.
struct Operand {
  std::vector<std::string_view> of_sets;
  Names words;
  std::vector<std::string_view> endings;
};

Operand operand_of(const Verb& verb) {
  Operand operand;
  const auto has = [&](std::string_view part) { return verb.operand.find(part) != std::string_view::npos; };
  for (const Set& set : sets)
    if (has(set.of)) operand.of_sets.push_back(set.name);
  if (has("ROBOT") || has("STUDY")) operand.endings = {"yaml"};
  if (has("RESULT")) operand.endings.insert(operand.endings.end(), {"csv", "h5"});
  std::string_view rest = verb.operand;
  while (!rest.empty()) {  // what is written small is meant as it is
    const std::size_t begin = rest.find_first_of("abcdefghijklmnopqrstuvwxyz");
    if (begin == std::string_view::npos) break;
    const std::size_t end = std::min(rest.find_first_of("|[]/", begin), rest.size());
    operand.words.push_back(rest.substr(begin, end - begin));
    rest.remove_prefix(end);
  }
  return operand;
}

/// Whether a table of rows comes second.
bool has_rows(const Verb& verb) { return verb.operand.ends_with(" ROWS"); }

/// Options whose values are words, in the order of the table.
std::vector<const Option*> options_of_words() {
  std::vector<const Option*> options;
  for (const Option& known : all_options())
    if (!known.words.empty()) options.push_back(&known);
  return options;
}

/// Of an option, whether its value is a file.
bool takes_file(const Option& known) { return known.value == "FILE"; }

/// `text` with a backslash before each of some characters.
std::string escaped(std::string_view text, std::string_view characters) {
  std::string result;
  for (const char c : text) {
    if (characters.find(c) != std::string_view::npos) result += '\\';
    result += c;
  }
  return result;
}

/// In single quotes, as zsh takes it.
std::string zsh_quoted(std::string_view text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + '\'';
}

/// In single quotes, as fish takes it.
std::string fish_quoted(std::string_view text) { return '\'' + escaped(text, "\\'") + '\''; }

std::string bash() {
  std::string lists, cases, values;
  for (const Set& set : sets)
    lists += fmt::format("  local {}=\"{}\"\n", set.name, fmt::join(set.words(), " "));
  for (const Option* known : options_of_words())
    values += fmt::format("      --{}) values=\"{}\"{} ;;\n", known->name, fmt::join(known->words, " "),
                          known->takes_list ? " list=1" : "");
  for (const Verb& verb : verbs()) {
    const Operand operand = operand_of(verb);
    std::string options, words;
    for (const std::string_view name : verb.options)
      options += fmt::format("{}--{}", options.empty() ? "" : " ", name);
    for (const std::string_view set : operand.of_sets) words += fmt::format("${} ", set);
    words += fmt::format("{}", fmt::join(operand.words, " "));
    cases += fmt::format("    {}) options=\"{}\" words=\"{}\" files=\"{}\" ;;\n", verb.name, options, words,
                         fmt::join(operand.endings, "|"));
  }
  return fmt::format(R"sh(# Completion of sinew for bash: source this file, or save it as
# ~/.local/share/bash-completion/completions/sinew
_sinew() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} verb=${{COMP_WORDS[1]}} options= words= files=
  local before=${{COMP_WORDS[COMP_CWORD-1]}} values= list= begun=
{}  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    mapfile -t COMPREPLY < <(compgen -W "$verbs --help --version" -- "$word")
    return
  fi
  case $verb in
{}  esac
  if [[ $word == = ]]; then  # --model=prb are three words here
    word=
  elif [[ $before == = ]]; then
    before=${{COMP_WORDS[COMP_CWORD-2]}}
  fi
  if [[ " $options " == *" $before "* ]]; then
    case $before in
{}    esac
  fi
  if [[ $values ]]; then
    [[ $list && $word == *,* ]] && begun=${{word%,*}},
    mapfile -t COMPREPLY < <(compgen -P "$begun" -W "$values" -- "${{word#"$begun"}}")
  elif [[ $word == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
  elif ((COMP_CWORD == 2)); then
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word"
                             [[ $files ]] || exit
                             compgen -d -S / -- "$word"
                             shopt -s extglob; compgen -f -X "!*.@($files)" -- "$word")
  fi
}}
complete -o default -o nospace -F _sinew sinew
)sh",
                     lists, cases, values);
}

/// `'--inputs[in leg order]:A, B, ...: '`, as _arguments has it.
std::string zsh_option(const Option& known) {
  const std::string text = escaped(known.help, "\\[]:");
  std::string value;
  if (!known.value.empty()) {
    std::string bare(known.value);
    std::erase(bare, '"');
    const std::string words = fmt::format("{}", fmt::join(known.words, " ")),
                      action = known.takes_list       ? "_values -s , word " + words
                               : !known.words.empty() ? '(' + words + ')'
                               : takes_file(known)    ? "_files"
                                                      : " ";
    value = fmt::format(":{}:{}", escaped(bare, "\\:"), action);
  }
  const std::string rest = zsh_quoted(fmt::format("[{}]{}", text, value));
  if (known.letter) return fmt::format("'(-{0} --{1})'{{-{0},--{1}}}{2}", known.letter, known.name, rest);
  return zsh_quoted(fmt::format("{}--{}[{}]{}", known.repeats ? "*" : "", known.name, text, value));
}

std::string zsh() {
  std::string lists, cases;
  for (const Set& set : sets) {
    if (set.name == "verbs") continue;
    lists += fmt::format("  local -a {}=({})\n", set.name, fmt::join(set.words(), " "));
  }
  lists += "  local -a verbs=(\n";
  for (const Verb& verb : verbs())
    lists +=
        fmt::format("    {}\n", zsh_quoted(fmt::format("{}:{}", verb.name, escaped(verb.summary, "\\:"))));
  lists += "  )\n";
  for (const Verb& verb : verbs()) {
    const Operand operand = operand_of(verb);
    std::string specs, words;
    for (const std::string_view name : verb.options)
      specs += fmt::format(" \\\n        {}", zsh_option(option(name)));
    for (const std::string_view set : operand.of_sets)
      words += set == "verbs" ? std::string(" ${verbs%%:*}") : fmt::format(" ${}", set);
    for (const std::string_view word : operand.words) words += fmt::format(" {}", word);
    cases += fmt::format(
        "    {})\n      words_of=({})\n      files='{}'\n      _arguments -s -S{} \\\n"
        "        '1:operand:_sinew_operand'{} ;;\n",
        verb.name, words.empty() ? words : words.substr(1), fmt::join(operand.endings, "|"), specs,
        has_rows(verb) ? " '2:rows:_files -g \"*.csv\"'" : "");
  }
  return fmt::format(R"sh(#compdef sinew
# Completion of sinew for zsh: save it as _sinew in a folder of $fpath, before compinit runs.
_sinew_operand() {{
  compadd -a words_of
  [[ -n $files ]] && _files -g "*.($files)"
}}
_sinew() {{
  local files
  local -a words_of
{}  if ((CURRENT == 2)); then
    _describe -t verbs verb verbs
    compadd -- --help --version
    return
  fi
  local verb=$words[2]
  shift words
  ((CURRENT--))
  case $verb in
{}  esac
}}
if [[ $funcstack[1] == _sinew ]]; then
  _sinew "$@"
else
  compdef _sinew sinew
fi
)sh",
                     lists, cases);
}

/// What follows an option, as fish has it.
std::string fish_value(const Option& known) {
  if (known.value.empty()) return "";
  if (takes_file(known)) return " -r -F";
  if (known.words.empty()) return " -x";
  const std::string words = fmt::format("{}", fmt::join(known.words, " "));
  return fmt::format(" -x -a '{}'", known.takes_list ? "(__sinew_list " + words + ")" : words);
}

std::string fish() {
  std::string lines;
  for (const Set& set : sets)
    if (set.name != "verbs")
      lines += fmt::format("set -g __sinew_{} {}\n", set.name, fmt::join(set.words(), " "));
  lines += fmt::format("set -g __sinew_verbs {}\n", fmt::join(verb_names(), " "));
  for (const Verb& verb : verbs())
    lines += fmt::format("complete -c sinew -n __sinew_begins -a {} -d {}\n", verb.name,
                         fish_quoted(verb.summary));
  lines +=
      "complete -c sinew -n __sinew_begins -l help -s h -d 'verbs and examples'\n"
      "complete -c sinew -n __sinew_begins -l version -s V -d 'the version'\n";
  for (const Verb& verb : verbs()) {
    const Operand operand = operand_of(verb);
    std::string words;
    for (const std::string_view set : operand.of_sets) words += fmt::format("$__sinew_{} ", set);
    words += fmt::format("{}", fmt::join(operand.words, " "));
    for (const std::string_view ending : operand.endings)
      words += fmt::format("{}(__fish_complete_suffix .{})", words.ends_with(' ') ? "" : " ", ending);
    if (!words.empty())
      lines += fmt::format("complete -c sinew -n '__sinew_operand {}' -a '{}'\n", verb.name, words);
    if (has_rows(verb))
      lines += fmt::format("complete -c sinew -n '__sinew_rows {}' -a '(__fish_complete_suffix .csv)'\n",
                           verb.name);
    for (const std::string_view name : verb.options) {
      const Option& known = option(name);
      lines += fmt::format("complete -c sinew -n '__sinew_verb {}' -l {}{}{} -d {}\n", verb.name, name,
                           known.letter ? fmt::format(" -s {}", known.letter) : "", fish_value(known),
                           fish_quoted(known.help));
    }
  }
  return R"(# Completion of sinew for fish: save it as ~/.config/fish/completions/sinew.fish
function __sinew_begins
  test (count (commandline -opc)) -eq 1
end
function __sinew_verb
  set -l words (commandline -opc)
  test (count $words) -ge 2; and test $words[2] = $argv[1]
end
function __sinew_operand
  __sinew_verb $argv; and test (count (commandline -opc)) -eq 2
end
function __sinew_rows
  __sinew_verb $argv; and test (count (commandline -opc)) -eq 3
end
function __sinew_list
  set -l begun (commandline -ct | string replace -r '^--[^=]*=' '' | string match -r '.*,')
  for word in $argv
    echo "$begun$word"
  end
end
complete -c sinew -f
)" + lines;
}

struct Shell {
  std::string_view name;
  std::string (*script)();
};
constexpr std::array shells{Shell{"bash", bash}, Shell{"zsh", zsh}, Shell{"fish", fish}};

}  // namespace

int run_completion(const Arguments& arguments) {
  const std::string word = arguments.operand();
  const auto shell = std::ranges::find(shells, word, &Shell::name);
  if (shell == shells.end())
    return refuse("completion",
                  {{"unknown_shell", word.empty() ? "shell" : in_quotes(word),
                    "completion is for bash, zsh and fish: sinew completion bash > sinew.bash"}});
  print(shell->script());
  return solved;
}

}  // namespace sinew::cli
