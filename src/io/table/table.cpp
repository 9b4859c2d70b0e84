#include "sinew/io/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>
#include <utility>

#include "base/assert.hpp"
#include "io/document/quantity.hpp"
#include "io/file/read_bytes.hpp"
#include "sinew/base/numbers.hpp"
#include "sinew/io/node.hpp"

namespace sinew::inline v1 {
namespace {

constexpr std::uintmax_t max_bytes = std::uintmax_t{4} << 30U;
constexpr std::size_t max_columns = 100'000;
constexpr std::size_t max_over = 1000;  // cells of a row beyond its columns, which are only counted
constexpr std::size_t max_errors = 20;  // of one file: after that it is not this kind of file

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";  // of spreadsheets

/// Quoted as RFC 4180 has it where the text would not read back as one cell, or a heading as a comment.
std::string csv_cell(const std::string& text) {
  const bool is_kept = text.find_first_of(",\"\n\r#") == std::string::npos && !text.empty() &&
                       trimmed(text) == text && !text.starts_with(byte_order_mark);
  if (is_kept) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
  return quoted + '"';
}

/// Reads the lines of one CSV text and collects what is wrong with them.
class CsvReader {
 public:
  CsvReader(std::string_view text, const std::string& source) : text_(text), source_(source) {}

  Expected<Table> table() {
    if (text_.starts_with(byte_order_mark)) text_.remove_prefix(byte_order_mark.size());
    std::string_view line;
    while (errors_.size() < max_errors && next(line)) take(line);
    if (errors_.empty() && table_.columns.empty())
      error("no_heading",
            "there is no line with column names; the first line that is not a comment must hold them");
    if (!errors_.empty()) return tl::unexpected<Errors>(std::move(errors_));
    return std::move(table_);
  }

 private:
  bool next(std::string_view& line) {
    if (text_.empty()) return false;
    const std::size_t end = text_.find('\n');
    line = text_.substr(0, end);
    text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    ++line_;
    return true;
  }

  void take(std::string_view line) {
    if (line.starts_with('#')) {
      line.remove_prefix(1);
      if (line.starts_with(' ')) line.remove_prefix(1);
      table_.comments.emplace_back(line);
    } else if (table_.columns.empty()) {
      if (!trimmed(line).empty()) take_heading(line);
    } else if (!trimmed(line).empty() ||
               table_.columns.size() == 1) {  // of one column, an empty line is a cell
      take_row(line);
    }
  }

  void take_heading(std::string_view line) {
    const std::vector<std::string> names = cells(line, max_columns + 1);
    if (names.size() > max_columns)
      return error("too_many_columns",
                   fmt::format("there are more than {} columns; give fewer", max_columns));
    std::unordered_set<std::string> known;
    for (const std::string& cell : names) {
      Column column = Column::named(cell);
      if (!known.insert(column.name).second)
        error("duplicate_column",
              fmt::format("the column {} is there twice; names must differ", in_quotes(column.name)));
      table_.columns.push_back(std::move(column));
    }
  }

  void take_row(std::string_view line) {
    const std::vector<std::string> row = cells(line, table_.columns.size() + max_over);
    if (row.size() != table_.columns.size()) {
      error("wrong_cell_count",
            fmt::format("{}{} cells, but the heading has {}; leave a cell empty where there is no "
                        "value",
                        row.size() == table_.columns.size() + max_over ? "at least " : "", row.size(),
                        table_.columns.size()));
      return;
    }
    for (std::size_t i = 0; i < row.size(); ++i) table_.columns[i].values.push_back(number(row[i], i));
  }

  double number(const std::string& cell, std::size_t column) {
    if (cell.empty()) return not_a_number;
    if (const auto value = parse_number(cell)) return *value;
    error("not_a_number", fmt::format("column {}: {} is not a number; write a decimal number, or nothing",
                                      in_quotes(table_.columns[column].name), in_quotes(cell)));
    return not_a_number;
  }

  /// Cells of one line, `most` of them; a quoted cell does not reach over lines.
  std::vector<std::string> cells(std::string_view line, std::size_t most) {
    std::vector<std::string> found;
    while (found.size() < most) {
      found.push_back(line.starts_with('"') ? quoted(line) : plain(line));
      if (line.empty()) return found;
      if (!line.starts_with(',')) {
        error("csv_syntax", "there is text after a closing quotation mark; a comma must follow it");
        return found;
      }
      line.remove_prefix(1);
    }
    return found;
  }

  static std::string plain(std::string_view& line) {
    const std::size_t end = std::min(line.find(','), line.size());
    std::string cell(trimmed(line.substr(0, end)));
    line.remove_prefix(end);
    return cell;
  }

  std::string quoted(std::string_view& line) {
    std::string cell;
    for (std::size_t i = 1; i < line.size(); ++i) {
      if (line[i] != '"') {
        cell += line[i];
      } else if (i + 1 < line.size() && line[i + 1] == '"') {
        cell += line[i++];
      } else {
        line.remove_prefix(i + 1);
        return cell;
      }
    }
    error("csv_syntax", "a quotation mark is not closed on its line");
    line = {};
    return cell;
  }

  void error(std::string_view code, std::string message) {
    if (errors_.size() >= max_errors) return;
    errors_.push_back({std::string(code), fmt::format("{}:{}", source_, line_), std::move(message)});
  }

  std::string_view text_;
  const std::string& source_;
  int line_ = 0;
  Table table_;
  Errors errors_;
};

}  // namespace

std::string Column::heading() const { return unit.empty() ? name : name + '[' + unit + ']'; }

Column Column::named(std::string_view heading) {
  const std::size_t open = heading.rfind('[');
  const bool is_index =  // `inputs[0]` is a name
      open != std::string_view::npos && open + 2 < heading.size() &&
      heading.substr(open + 1, heading.size() - open - 2).find_first_not_of("0123456789") ==
          std::string_view::npos;
  if (!heading.ends_with(']') || open == std::string_view::npos || is_index)
    return {std::string(heading), "", {}};
  return {std::string(trimmed(heading.substr(0, open))),
          std::string(heading.substr(open + 1, heading.size() - open - 2)),
          {}};
}

Table::Table(std::initializer_list<std::string_view> headings) {
  for (const std::string_view heading : headings) columns.push_back(Column::named(heading));
}

void Table::add_row(Numbers row) {
  SINEW_EXPECTS(row.size() == columns.size());
  for (std::size_t i = 0; i < columns.size(); ++i)
    columns[i].values.push_back(i < row.size() ? row[i] : std::numeric_limits<double>::quiet_NaN());
}

const Column* Table::find(std::string_view name) const {
  const auto found =
      std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.name == name; });
  return found == columns.end() ? nullptr : &*found;
}

std::string to_csv(const Table& table) {
  std::string text;
  for (const std::string& comment : table.comments) {
    std::string line = comment;
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    text += line.empty() ? "#\n" : "# " + line + '\n';
  }
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    text += (i == 0 ? "" : ",") + csv_cell(table.columns[i].heading());
  text += '\n';
  std::vector<double> values(table.columns.size());
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = table.columns[i].values[row];
    append_csv_row(text, values);
  }
  return text;
}

void append_csv_row(std::string& text, Numbers row) {
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (i > 0) text += ',';
    if (std::isfinite(row[i])) text += si_text(row[i]);
  }
  text += '\n';
}

Expected<Table> parse_csv(std::string_view text, const std::string& source) {
  return CsvReader(text, source).table();
}

Expected<void> write_csv(const Table& table, const std::filesystem::path& path) {
  return write_text(to_csv(table), path);
}

Expected<Table> read_csv(const std::filesystem::path& path) {
  const auto text = read_bytes(path, max_bytes);
  return text ? parse_csv(*text, path.string()) : tl::unexpected(text.error());
}

}  // namespace sinew::inline v1
