#include "io/document/parse.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <unistd.h>
#include <bit>
#include <cmath>
#include <random>

#include <filesystem>
#include <fstream>

namespace parse_test {

using namespace sinew;
using Kind = Node::Kind;

Document yaml(std::string_view text) {
  auto result = parse_yaml(text, "f.yaml");
  EXPECT_TRUE(result) << (result ? "" : to_string(result.error()));
  return result.value_or(Document{});
}

std::string yaml_errors(std::string_view text) {
  const auto result = parse_yaml(text, "f.yaml");
  return result ? "" : to_string(result.error());
}

std::string json_errors(std::string_view text) {
  const auto result = parse_json(text, "query");
  return result ? "" : to_string(result.error());
}

std::string repeated(std::string_view text, int times) {
  std::string result;
  for (int i = 0; i < times; ++i) result += text;
  return result;
}

TEST(ParseYaml, PlainScalarsHaveAKind) {
  struct Row {
    const char* text;
    Kind kind;
  };
  for (const Row& row : {Row{"~", Kind::null},    {"null", Kind::null},     {"", Kind::null},
                         {"true", Kind::boolean}, {"false", Kind::boolean}, {"yes", Kind::string},
                         {"True", Kind::string},  {"1", Kind::number},      {"+1.5e3", Kind::number},
                         {"-.5", Kind::number},   {"0x1F", Kind::string},   {".inf", Kind::string},
                         {"inf", Kind::string},   {".nan", Kind::string},   {"nan", Kind::string},
                         {"1e999", Kind::string}, {"175 mm", Kind::string}, {"1_000", Kind::string},
                         {"12:30", Kind::string}, {"'1'", Kind::string},    {"\"true\"", Kind::string},
                         {"''", Kind::string},    {"[1, 2]", Kind::list},   {"{a: 1}", Kind::map}}) {
    const Document document = yaml(std::string("key: ") + row.text + "\n");
    EXPECT_EQ(document.root.members.at(0).value.kind, row.kind) << row.text;
  }
  EXPECT_EQ(yaml("a: +1.5e3").root.find("a")->number, 1500.0);
  EXPECT_EQ(yaml("a: +1.5e3").root.find("a")->text, "+1.5e3");
  EXPECT_EQ(yaml("a: true").root.find("a")->boolean, true);
}

TEST(ParseYaml, EveryNodeHasItsPlace) {
  const Document document = yaml(
      "# a robot\n"
      "name: my robot\n"
      "legs:\n"
      "  - link: {type: arc, length: 200 mm}\n"
      "    point: [0.1, \"5 mm\"]\n"
      "  -\n"
      "    link:\n"
      "      note: |\n"
      "        text\n"
      "empty:\n"
      "\n"
      "last: 1\n");
  const auto where = [&](std::string_view path) { return place(document, *at(document.root, path)); };
  EXPECT_EQ(where(""), "f.yaml:2:1");
  EXPECT_EQ(where("name"), "f.yaml:2:7");
  EXPECT_EQ(where("legs"), "f.yaml:4:3");
  EXPECT_EQ(where("legs[0]"), "f.yaml:4:5");
  EXPECT_EQ(where("legs[0].link"), "f.yaml:4:11");
  EXPECT_EQ(where("legs[0].link.length"), "f.yaml:4:31");
  EXPECT_EQ(where("legs[0].point[1]"), "f.yaml:5:18");
  EXPECT_EQ(where("legs[1].link"), "f.yaml:8:7");
  EXPECT_EQ(where("empty"), "f.yaml:10:1");
  EXPECT_EQ(where("last"), "f.yaml:12:7");
  const Member& link = document.root.members[1].value.items[0].members[0];
  EXPECT_EQ(link.line, 4);
  EXPECT_EQ(link.column, 5);
}

TEST(ParseYaml, EveryDuplicateKeyIsNamed) {
  EXPECT_EQ(
      yaml_errors("a: 1\nb: {x: 1, y: 2, x: 3}\na: 2\nc: [{k: 1, k: 2}]\n"),
      "f.yaml:2:17: \"x\" is given twice in b; it was first given at line 2; keep one. [duplicate_key]\n"
      "f.yaml:3:1: \"a\" is given twice; it was first given at line 1; keep one. [duplicate_key]\n"
      "f.yaml:4:12: \"k\" is given twice in c[0]; it was first given at line 4; keep one. [duplicate_key]");
}

TEST(ParseYaml, TheSameKeyInTwoMapsIsFine) { EXPECT_EQ(yaml("- {a: 1}\n- {a: 1}\n").root.items.size(), 2U); }

TEST(ParseYaml, AnchorsAliasesAndTagsAreRefused) {
  EXPECT_EQ(yaml_errors("a: &x 1\nb: *x\n"),
            "f.yaml:1:4: anchors (&name) are not read here; write the value out where it is used. "
            "[yaml_unsupported]");
  EXPECT_NE(yaml_errors("b: *x\n"), "");
  EXPECT_EQ(yaml_errors("a: !!float 1\n"),
            "f.yaml:1:4: tags (\"tag:yaml.org,2002:float\") are not read here; write the "
            "plain value. [yaml_unsupported]");
  EXPECT_NE(yaml_errors("a: !mine {b: 1}\n").find("yaml_unsupported"), std::string::npos);
  EXPECT_NE(yaml_errors("a: !mine [1]\n").find("yaml_unsupported"), std::string::npos);
}

TEST(ParseYaml, OneDocumentAFile) {
  EXPECT_EQ(yaml("---\na: 1\n...\n").root.members.size(), 1U);
  EXPECT_EQ(yaml_errors("a: 1\n---\nb: 2\n"),
            "f.yaml:2:1: the one document has ended, but the file goes on here; look for a stray \"---\", "
            "quote or bracket, "
            "or for a wrong indentation. [yaml_unsupported]");
  EXPECT_NE(yaml_errors("- a\nb: 1\n").find("f.yaml:2:1: the one document has ended"), std::string::npos);
}

TEST(ParseYaml, KeysAreWords) {
  EXPECT_EQ(yaml_errors("? [a, b]\n: 1\n"),
            "f.yaml:1:3: a list stands where a key must be; is a bracket not closed? [yaml_unsupported]");
  EXPECT_NE(yaml_errors("? {a: b}\n: 1\n").find("a map stands where a key must be"), std::string::npos);
  EXPECT_NE(yaml_errors(": 1\n").find("a key is empty"), std::string::npos);
  EXPECT_EQ(yaml("1: a\ntrue: b\n\"x y\": c\n").root.members[1].key, "true");
}

TEST(ParseYaml, SyntaxErrorsAreInPlainWords) {
  EXPECT_EQ(yaml_errors("a: b: c\n"),
            "f.yaml:1:5: a \":\" where no value can be; put text that holds \": \" in quotes, and "
            "check the indentation. [yaml_syntax]");
  EXPECT_NE(yaml_errors("a: [1, 2\nb: 3\n").find("is not closed"), std::string::npos)
      << yaml_errors("a: [1, 2\nb: 3\n");
  EXPECT_NE(yaml_errors("a: {b: 1\n").find("is not closed"), std::string::npos) << yaml_errors("a: {b: 1\n");
  EXPECT_NE(yaml_errors("a: \"text\n").find("never closed"), std::string::npos) << yaml_errors("a: \"text\n");
  EXPECT_NE(yaml_errors("a: 1\n b: 2\n").find("f.yaml:2"), std::string::npos) << yaml_errors("a: 1\n b: 2\n");
  EXPECT_EQ(yaml_errors("a:\n\tb: 2\n"),
            "f.yaml:2:3: a tab indents this line; indent with spaces. [yaml_syntax]");
  EXPECT_NE(yaml_errors("a: @b\n").find("cannot start a value"), std::string::npos) << yaml_errors("a: @b\n");
  EXPECT_NE(yaml_errors("a: 1\n- b\n").find("[yaml_syntax]"), std::string::npos)
      << yaml_errors("a: 1\n- b\n");
}

TEST(ParseYaml, AnUnclosedQuoteDoesNotSwallowTheFile) {  // yaml-cpp 0.7 lets it
  for (const char* text :
       {"a: \"text\nb: 1\n", "a: 'text\nb: 1\n", "a: \"text\\\"\n", "a: 'it''s\n", "a: \"", "- 'x"})
    EXPECT_NE(yaml_errors(text).find("a quote is opened and never closed. [yaml_syntax]"), std::string::npos)
        << text;
  EXPECT_EQ(yaml("a: 'it''s'").root.find("a")->text, "it's");
  EXPECT_EQ(yaml("µ: x\r\na: \"say \\\"hi\\\"\"").root.find("a")->text, "say \"hi\"");
  EXPECT_EQ(yaml("a: |\n  \"text\n").root.find("a")->text, "\"text\n");
  EXPECT_NE(yaml_errors("a: ! 5\n").find("tags"), std::string::npos);
}

TEST(ParseYaml, DuplicatesBeforeASyntaxErrorAreKept) {
  const auto result = parse_yaml("a: 1\na: 2\nb: [1\n", "f.yaml");
  ASSERT_FALSE(result);
  ASSERT_EQ(result.error().size(), 2U);
  EXPECT_EQ(result.error()[0].code, "duplicate_key");
  EXPECT_EQ(result.error()[1].code, "yaml_syntax");
}

TEST(ParseYaml, WindowsFilesRead) {
  const Document document = yaml(
      "\xEF\xBB\xBF"
      "a: 1\r\nb:\r\n  - x\r\n  - 2 mm\r\n");
  EXPECT_EQ(document.root.find("a")->number, 1.0);
  EXPECT_EQ(document.root.members[0].key, "a");
  EXPECT_EQ(document.root.members[0].column, 1);
  EXPECT_EQ(at(document.root, "b[1]")->text, "2 mm");
  EXPECT_EQ(place(document, *at(document.root, "b[1]")), "f.yaml:4:5");
}

TEST(ParseYaml, OnlyUtf8) {
  EXPECT_EQ(yaml("name: Käfer µ 机器人 🤖\n").root.find("name")->text, "Käfer µ 机器人 🤖");
  EXPECT_EQ(
      yaml_errors("a: 1\nb: \xE9t\xE9\n"),
      "f.yaml:2:4: this is not plain text; save the file as UTF-8, without control characters. [not_utf8]");
  for (std::string_view bad : {"\xC0\xAF", "\xED\xA0\x80", "\xF5\x80\x80\x80", "\xE2\x82", "\x80", "\xFF\xFE",
                               "\xF0\x80\x80\x80", "\xE0\x80\x80", "\xF4\x90\x80\x80"})
    EXPECT_NE(yaml_errors(bad).find("not_utf8"), std::string::npos);
  EXPECT_EQ(yaml_errors("a: 1\n\x04"
                        "b: 2\n")
                .substr(0, 11),
            "f.yaml:2:1:");  // yaml-cpp would stop here and be content
  EXPECT_NE(yaml_errors(std::string_view("a\0: \0", 5)).find("not_utf8"),
            std::string::npos);  // UTF-16 without a mark
}

TEST(ParseYaml, NothingIsAnError) {
  for (const char* text : {"", "\n", "# only a comment\n", "---\n", "\xEF\xBB\xBF"})
    EXPECT_EQ(yaml_errors(text), "f.yaml: there is nothing in it. [empty_document]") << text;
}

TEST(ParseYaml, BombsAreHarmless) {
  EXPECT_EQ(yaml(repeated("[", 64) + repeated("]", 64)).root.kind, Kind::list);
  EXPECT_EQ(yaml_errors(repeated("[", 65) + repeated("]", 65)),
            "f.yaml:1:65: more than 64 levels of lists and maps. [too_deep]");
  EXPECT_NE(yaml_errors(repeated("[", 100'000)), "");
  EXPECT_NE(yaml_errors(repeated("a: [", 50'000)).find("too_deep"), std::string::npos);
  EXPECT_NE(yaml_errors(repeated("- ", 100'000)).find("too_deep"), std::string::npos);
  EXPECT_NE(yaml_errors(repeated("{a: ", 10'000)), "");
  EXPECT_NE(yaml_errors("[" + repeated("1,", 250'000) + "1]").find("more than 200000 values"),
            std::string::npos);
  EXPECT_NE(yaml_errors(std::string(document_size_limit + 1, ' ')).find("too_large"), std::string::npos);
}

TEST(ParseYaml, AMapOfManyKeysIsNotQuadratic) {
  std::string text;
  for (int i = 0; i < 60'000; ++i) text += "key" + std::to_string(i) + ": 1\n";
  EXPECT_EQ(yaml(text).root.members.size(), 60'000U);
}

TEST(ParseJson, TheSameTree) {
  const auto document = parse_json(
      R"({"a": [1, -2, 3.50, "4 mm", true, null], "b": {}, "big": 18446744073709551615})", "query");
  ASSERT_TRUE(document);
  const Node& a = *document->root.find("a");
  EXPECT_EQ(a.items[0].number, 1.0);
  EXPECT_EQ(a.items[1].text, "-2");
  EXPECT_EQ(a.items[2].text, "3.50");
  EXPECT_EQ(a.items[3].text, "4 mm");
  EXPECT_EQ(a.items[4].boolean, true);
  EXPECT_EQ(a.items[5].kind, Kind::null);
  EXPECT_EQ(a.line, 0);
  EXPECT_EQ(document->root.find("b")->kind, Kind::map);
  EXPECT_EQ(document->root.find("big")->number, 18446744073709551615.0);
}

bool is_same(const Node& a, const Node& b) {
  return a.kind == b.kind && a.boolean == b.boolean && a.text == b.text &&
         std::bit_cast<std::uint64_t>(a.number) == std::bit_cast<std::uint64_t>(b.number) &&
         std::ranges::equal(a.items, b.items, is_same) &&
         std::ranges::equal(a.members, b.members, [](const Member& one, const Member& other) {
           return one.key == other.key && is_same(one.value, other.value);
         });
}

/// A text with an escape anywhere is read by the parser of odd texts, one without by that of plain ones.
TEST(ParseJson, PlainTextsAreReadAsOddOnes) {
  std::vector<std::string> texts{"0",
                                 "-0",
                                 "-0.0",
                                 "1",
                                 "-12",
                                 "012",
                                 "-",
                                 "+1",
                                 "1.",
                                 ".5",
                                 "1.5",
                                 "-1.25e-3",
                                 "1e5",
                                 "1E+5",
                                 "1e",
                                 "1e+",
                                 "123456789012345",
                                 "1234567890123456",
                                 "18446744073709551615",
                                 "18446744073709551616",
                                 "1e308",
                                 "1e309",
                                 "-1e309",
                                 "1e-320",
                                 "5e-324",
                                 "1e-400",
                                 "0.1234567890123456789012345",
                                 "true",
                                 "false",
                                 "null",
                                 "tru",
                                 "nulls",
                                 "True",
                                 "\"\"",
                                 "\"a b\"",
                                 "\"a",
                                 "\"\x7f\"",
                                 "\"\t\"",
                                 "\"\u00e9\"",
                                 "[]",
                                 "{}",
                                 "[1,2]",
                                 "[1,]",
                                 "[,1]",
                                 "[1 2]",
                                 "[ 1 , 2 ]",
                                 "{\"a\":1}",
                                 "{\"a\":1,\"a\":2}",
                                 "{\"a\":1,}",
                                 "{\"a\" 1}",
                                 "{a:1}",
                                 "{\"a\":{\"b\":[1,{\"c\":null}]}}",
                                 "\n\t 1\r\n",
                                 "1 1",
                                 "",
                                 " ",
                                 "]",
                                 "}",
                                 "NaN",
                                 "Infinity",
                                 "0x10",
                                 "1_000",
                                 "\xef\xbb\xbf"
                                 "1",
                                 "// 1",
                                 "1//",
                                 std::string(70, '[') + std::string(70, ']'),
                                 "[1]]",
                                 "{\"a\"}"};
  std::mt19937 random(4);
  const std::string_view letters = "[]{}:,\"-+.eE0123456789 truefalsn\\a";
  for (int k = 0; k < 20000; ++k) {
    std::string text;
    const std::size_t size = 1 + random() % 12;
    for (std::size_t i = 0; i < size; ++i) text += letters[random() % letters.size()];
    texts.push_back(text);
  }
  for (int k = 0; k < 20000; ++k) {
    const double value = std::bit_cast<double>(std::uint64_t{random()} << 32U | random());
    if (std::isfinite(value)) texts.push_back(fmt::format("{}", value));
    texts.push_back(fmt::format("{:.{}e}", value, random() % 25));
    int exponent = 0;  // of no meaning where the value is not finite
    const double usual = 4096 * std::frexp(value, &exponent);
    if (std::isfinite(usual)) texts.push_back(fmt::format("{:.{}f}", usual, random() % 14));
  }
  for (const std::string& text : texts) {
    const auto plain = parse_json("[\"A\"," + text + "]", "q"),
               odd = parse_json("[\"\\u0041\"," + text + "]", "q");
    ASSERT_EQ(plain.has_value(), odd.has_value()) << text;
    if (plain) {
      ASSERT_TRUE(is_same(plain->root, odd->root)) << text;
    } else {
      ASSERT_EQ(plain.error().front().code, odd.error().front().code) << text;
    }
  }
}

TEST(ParseJson, ErrorsAreInPlainWords) {
  EXPECT_EQ(
      json_errors("{\"a\": 1,\n]"),
      "query: this is not JSON, at line 2, column 1: unexpected ']'; expected string literal. [json_syntax]");
  EXPECT_EQ(json_errors("{\"a\": nul}"),
            "query: this is not JSON, at line 1, column 10: invalid literal. [json_syntax]");
  EXPECT_EQ(
      json_errors("{\"a\": \" - x; expected "),
      "query: this is not JSON, at line 1, column 23: invalid string: missing closing quote. [json_syntax]");
  for (const char* text :
       {"", " ", "{", "[1,]", "{\"a\" 1}", "NaN", "[1] 2", "{'a': 1}", "\"\t\"", "\"\\x\"", "01", "--1"}) {
    const std::string message = json_errors(text);
    EXPECT_NE(message.find("[json_syntax]"), std::string::npos) << text;
    EXPECT_EQ(message.find("json.exception"), std::string::npos) << message;
  }
}

TEST(ParseJson, DuplicatesOverflowDepthAndBytesAreRefused) {
  EXPECT_EQ(json_errors(R"({"a": {"b": 1, "b": 2}})"),
            "query: \"b\" is given twice in a; keep one. [duplicate_key]");
  EXPECT_EQ(json_errors("[1e999]"), "query: 1e999 is too large for a number. [not_a_number]");
  EXPECT_NE(json_errors(repeated("[", 65) + repeated("]", 65)).find("too_deep"), std::string::npos);
  EXPECT_NE(json_errors(repeated("[", 1'000'000)).find("too_deep"), std::string::npos);
  EXPECT_NE(json_errors("\"\xFF\"").find("not_utf8"), std::string::npos);
  EXPECT_NE(json_errors(std::string(document_size_limit + 1, ' ')).find("too_large"), std::string::npos);
}

class ReadFile : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string write(std::string_view text) const {
    const std::string path = folder_ / "robot.yaml";
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }
  static std::string code(const std::string& path) {
    const auto result = read_file(path);
    if (result) return "";
    EXPECT_EQ(result.error().front().where.rfind(path, 0), 0U);
    return result.error().front().code;
  }
  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("sinew_io_" + std::to_string(::getpid()));
};

TEST_F(ReadFile, ReadsAFile) {
  const std::string path = write("name: a\n");
  const auto document = read_file(path);
  ASSERT_TRUE(document);
  EXPECT_EQ(document->source, path);
  EXPECT_EQ(document->root.find("name")->text, "a");
}

TEST_F(ReadFile, SaysWhyItCannot) {
  EXPECT_EQ(code((folder_ / "none.yaml").string()), "file_missing");
  EXPECT_EQ(code((folder_ / "no" / "folder.yaml").string()), "file_missing");
  EXPECT_EQ(code(""), "file_missing");
  EXPECT_EQ(code(folder_.string()), "file_unreadable");
  EXPECT_EQ(code("/dev/zero"), "file_unreadable");
  EXPECT_EQ(code(write("")), "empty_document");
  EXPECT_EQ(code(write("\xFF\xFE")), "not_utf8");
  EXPECT_EQ(code(write("#" + std::string(document_size_limit, ' '))), "too_large");
  EXPECT_EQ(code(write(std::string("a: 1 #") + std::string(document_size_limit - 6, ' '))), "");
}

}  // namespace parse_test
