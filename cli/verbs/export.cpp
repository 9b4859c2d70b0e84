/// export: a robot in the languages of what drives it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "io/document/visible.hpp"
#include "io/export/export.hpp"
#include "io/file/write_file.hpp"
#include "serial_robot.hpp"
#include "terminal.hpp"
#include "verbs.hpp"

namespace sinew::cli {
namespace {

struct Language {
  std::string_view name;
  std::vector<ExportedFile> (*write)(const ControllerTable&);
  bool has_exact;  ///< exact PCC, too
};

const std::array languages{
    Language{"c-header",
             [](const ControllerTable& table) {
               return std::vector<ExportedFile>{{"robot_table.h", controller_header(table)}};
             },
             true},
    Language{"verilog", controller_verilog, false},
};

const Language* find_language(std::string_view name) {
  const auto found = std::ranges::find(languages, name, &Language::name);
  return found == languages.end() ? nullptr : &*found;
}

int refuse_language(const std::string& word) {
  std::vector<std::string_view> names;
  for (const Language& language : languages) names.push_back(language.name);
  const std::string_view hint = closest(word, names);
  return refuse("export", {{"unknown_choice", "--to",
                            fmt::format("no such language{} There are: {}.",
                                        hint.empty() ? "." : fmt::format("; did you mean {}?", hint),
                                        fmt::join(names, ", "))}});
}

Expected<kernel::Model> read_model(const Arguments& arguments, const Language& language) {
  auto model = tendon_model(arguments);
  if (model && *model == kernel::Model::exact && !language.has_exact)
    return failure("not_available", "--model",
                   fmt::format("{} is of lsk alone; c-header has pcc, too", language.name));
  return model;
}

Expected<ControllerTable> read_table(const Arguments& arguments, const Language& language) {
  const auto robot = open_serial(arguments);
  if (!robot) return tl::unexpected(robot.error());
  const auto model = read_model(arguments, language);
  return model ? make_controller_table(*robot, *model) : tl::unexpected(model.error());
}

/// One file into the file that is named, or on stdout; several into the folder that is named, all or none.
Expected<void> write(const std::vector<ExportedFile>& files, const Arguments& arguments) {
  const std::string* output = arguments.text("output");
  if (files.size() == 1 && !output) return print(files[0].text), Expected<void>();
  std::string names;
  std::vector<FileWriter> writers;
  for (const ExportedFile& file : files) {
    const std::filesystem::path path = files.size() == 1
                                           ? std::filesystem::path(*output)
                                           : std::filesystem::path(output ? *output : ".") / file.name;
    auto writer = FileWriter::open(path);
    if (!writer) return tl::unexpected(std::move(writer.error()));
    if (auto written = writer->write(file.text); !written) return written;
    writers.push_back(std::move(*writer));
    names += visible_line(path.string()) + '\n';
  }
  if (auto done = finish_together(writers); !done) return done;
  if (!arguments.has("quiet")) print(names);
  return {};
}

}  // namespace

int run_export(const Arguments& arguments) {
  const std::string* name = arguments.text("to");
  const Language* language = name ? find_language(*name) : nullptr;
  if (!language) return refuse_language(name ? *name : "");
  const auto table = read_table(arguments, *language);
  if (!table) return refuse("export", table.error());
  const auto written = write(language->write(*table), arguments);
  return written ? solved : refuse("export", written.error());
}

}  // namespace sinew::cli
