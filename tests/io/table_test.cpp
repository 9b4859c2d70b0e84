#include "sinew/io/table.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace table_test {

using namespace sinew;
namespace fs = std::filesystem;

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

/// A folder of this process that goes with it.
struct Folder {
  fs::path path = fs::temp_directory_path() / ("sinew_table_" + std::to_string(getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
};

std::string error_of(std::string_view text) {
  const auto table = parse_csv(text, "t.csv");
  return table ? "no error" : to_string(table.error());
}

TEST(Table, WritesNamesUnitsAndTheShortestNumbers) {
  Table table{"k", "x[m]", "rate[rad/m]"};
  table.comments = {"what this is", ""};
  table.add_row({0, 0.1, missing});
  table.add_row({1, -1e-300, 1.0 / 3});
  EXPECT_EQ(to_csv(table), "# what this is\n#\nk,x[m],rate[rad/m]\n0,0.1,\n1,-1e-300,0.3333333333333333\n");
}

TEST(Table, AValueThatIsNotFiniteIsAnEmptyCell) {
  Table table{"a", "b", "c"};
  table.add_row({missing, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()});
  EXPECT_EQ(to_csv(table), "a,b,c\n,,\n");
}

TEST(Table, ReadsBackWhatItWrote) {
  Table table{"k", "a \"name\", with a comma[m]", "#c"};
  table.comments = {"one", "", "three"};
  table.add_row({0, 0.1, missing});
  table.add_row({missing, missing, missing});
  table.add_row({5e-324, 1.7976931348623157e308, -0.0});
  const auto read = parse_csv(to_csv(table), "t.csv");
  ASSERT_TRUE(read) << to_string(read.error());
  EXPECT_EQ(read->comments, table.comments);
  ASSERT_EQ(read->row_count(), 3U);
  EXPECT_EQ(read->columns[1].name, "a \"name\", with a comma");
  EXPECT_EQ(read->columns[1].unit, "m");
  EXPECT_EQ(read->find("#c"), &read->columns[2]);
  EXPECT_EQ(read->find("missing"), nullptr);
  EXPECT_EQ(to_csv(*read), to_csv(table));
}

TEST(Table, AnIndexIsPartOfTheName) {
  const auto read = parse_csv("gain[0],gain[1],pull[2][mm],x[1/m]\n1,2,3,4\n", "t.csv");
  ASSERT_TRUE(read) << to_string(read.error());
  EXPECT_EQ(read->columns[1].name, "gain[1]");
  EXPECT_EQ(read->columns[1].unit, "");
  EXPECT_EQ(read->columns[2].name, "pull[2]");
  EXPECT_EQ(read->columns[2].unit, "mm");
  EXPECT_EQ(read->columns[3].unit, "1/m");
  EXPECT_EQ(to_csv(*read), "gain[0],gain[1],pull[2][mm],x[1/m]\n1,2,3,4\n");
}

TEST(Table, HeadingsOfBlanksComeBack) {
  for (const char* name : {"", " ", " a ", "\xEF\xBB\xBF",
                           "\xEF\xBB\xBF"
                           "a"}) {
    Table table{name};
    table.add_row({1.0});
    const auto read = parse_csv(to_csv(table), "t.csv");
    ASSERT_TRUE(read) << to_string(read.error());
    EXPECT_EQ(read->columns[0].name, name);
    EXPECT_EQ(read->row_count(), 1U);
  }
}

TEST(Table, WideTablesAreReadInLinearTimeAndEndlessOnesRefused) {
  std::string heading, row;
  for (int k = 0; k < 100000; ++k) {
    heading += (k ? ",c" : "c") + std::to_string(k);
    row += k ? ",1" : "1";
  }
  const auto wide =
      parse_csv(heading + '\n' + row + '\n', "t.csv");  // a minute where each name is compared with all
  ASSERT_TRUE(wide) << to_string(wide.error());
  EXPECT_EQ(wide->columns.size(), 100000U);
  EXPECT_NE(error_of(heading + ",one_more\n").find("[too_many_columns]"), std::string::npos);
  EXPECT_NE(error_of("a\n" + std::string(5'000'000, ',')).find("at least 1001 cells"), std::string::npos);
  std::string bad = "c0";
  for (int k = 1; k < 100; ++k) bad += ",c" + std::to_string(k);
  const auto many = parse_csv(bad + '\n' + bad + '\n', "t.csv");
  ASSERT_FALSE(many);
  EXPECT_EQ(many.error().size(), 20U) << "also of one line";
}

RC_GTEST_PROP(Table, EveryFiniteNumberComesBackToTheBit, (std::vector<std::uint64_t> bits)) {
  Table table{"only[m]"};
  for (std::uint64_t& b : bits) {
    b *= 0x9e3779b97f4a7c15U;  // small ones would all be denormal
    double value = 0;
    std::memcpy(&value, &b, sizeof value);
    table.add_row({value});
  }
  const auto read = parse_csv(to_csv(table), "t.csv");
  RC_ASSERT(read.has_value());
  RC_ASSERT(read->row_count() == table.row_count());
  for (std::size_t i = 0; i < bits.size(); ++i) {
    const double before = table.columns[0].values[i], after = read->columns[0].values[i];
    const bool same =
        std::isfinite(before) ? std::memcmp(&before, &after, sizeof before) == 0 : std::isnan(after);
    RC_ASSERT(same);
  }
}

TEST(Table, ReadsWhatSpreadsheetsWrite) {
  const auto table = parse_csv("\xEF\xBB\xBF# c\r\n\r\n x [m] ,\"y\"\r\n 1 , 2e3\r\n\r\n3,\r\n4,5", "t.csv");
  ASSERT_TRUE(table) << to_string(table.error());
  EXPECT_EQ(table->comments, std::vector<std::string>{"c"});
  EXPECT_EQ(table->columns[0].heading(), "x[m]");
  EXPECT_EQ(table->columns[1].heading(), "y");
  ASSERT_EQ(table->row_count(), 3U);
  EXPECT_EQ(table->columns[1].values[0], 2000);
  EXPECT_TRUE(std::isnan(table->columns[1].values[1]));
  EXPECT_EQ(table->columns[1].values[2], 5);
}

TEST(Table, ErrorsNameTheLineAndTheRule) {
  EXPECT_EQ(
      error_of("# c\na,b\n1,2\n1,2,3\n1,two\n"),
      "t.csv:4: 3 cells, but the heading has 2; leave a cell empty where there is no value "
      "[wrong_cell_count]\n"
      "t.csv:5: column \"b\": \"two\" is not a number; write a decimal number, or nothing [not_a_number]");
  EXPECT_NE(error_of("a,a[m]\n").find("t.csv:1: the column \"a\" is there twice"), std::string::npos);
  EXPECT_NE(error_of("# only\n").find("[no_heading]"), std::string::npos);
  EXPECT_NE(error_of("").find("[no_heading]"), std::string::npos);
  EXPECT_NE(error_of("a,\"b\n").find("t.csv:1: a quotation mark is not closed"), std::string::npos);
  EXPECT_NE(error_of("a,\"b\"c\n").find("[csv_syntax]"), std::string::npos);
  for (const char* cell : {"nan", "inf", "0x10", "1 2", "1e999", "--1"})
    EXPECT_NE(error_of(std::string("a,b\n0,") + cell + "\n").find("t.csv:2: "), std::string::npos) << cell;
}

TEST(Table, AFileThatIsNoTableIsNotReadToItsEnd) {
  std::string text = "a\n";
  for (int i = 0; i < 10000; ++i) text += "x\n";
  const auto table = parse_csv(text, "t.csv");
  ASSERT_FALSE(table);
  EXPECT_EQ(table.error().size(), 20U);
}

TEST(Table, FilesAreWrittenWithTheirFoldersAndRead) {
  const Folder folder;
  Table table{"x[m]"};
  table.add_row({0.25});
  const fs::path path = folder.path / "a" / "b" / "t.csv";
  ASSERT_TRUE(write_csv(table, path));
  const auto read = read_csv(path);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->columns[0].values[0], 0.25);
}

TEST(Table, PipesAreNotWaitedFor) {
  const Folder folder;
  ASSERT_EQ(mkfifo((folder.path / "p.csv").c_str(), 0600), 0);
  for (const fs::path& path : {folder.path / "p.csv", fs::path("/dev/zero")}) {
    const auto read = read_csv(path);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().front().code, "file_unreadable");
    EXPECT_NE(read.error().front().message.find("pipe or a device"), std::string::npos);
  }
}

TEST(Table, FilesThatCannotBeReadOrWrittenAreErrors) {
  const Folder folder;
  const auto absent = read_csv(folder.path / "none.csv"), directory = read_csv(folder.path);
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().front().code, "file_missing");
  ASSERT_FALSE(directory);
  EXPECT_EQ(directory.error().front().code, "file_unreadable");
  ASSERT_TRUE(write_text("a file, not a folder", folder.path / "file"));
  for (const fs::path& path :
       {folder.path / "file" / "t.csv", folder.path / "file" / "b" / "t.csv", folder.path}) {
    const auto written = write_csv(Table{"x"}, path);
    ASSERT_FALSE(written) << path;
    EXPECT_EQ(written.error().front().code, "file_unwritable");
  }
}

}  // namespace table_test
