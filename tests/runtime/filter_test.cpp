// SPDX-License-Identifier: MIT
#include "stipple/filter.h"

#include <fnmatch.h>
#include <gtest/gtest.h>

#include <optional>
#include <random>
#include <string>
#include <vector>

namespace stipple {
namespace {

struct Filter {
  std::vector<FilterRule> rules;
  FilterProblem problem;

  explicit Filter(std::string_view text) {
    rules.resize(ReadFilter(text, nullptr, 0, problem));
    EXPECT_EQ(ReadFilter(text, rules.data(), rules.size(), problem), rules.size());
  }
  FilterAnswer Of(std::string_view demangled, std::string_view linkage = "l",
                  std::string_view file = "f.c") {
    return ApplyFilter(rules.data(), rules.size(), {demangled, linkage, file});
  }
  std::string Problem() const {
    if (problem.line == 0) return "";
    return std::to_string(problem.line) + ": '" + std::string(problem.word) + "' " + problem.what;
  }
};

/// Texts of up to `most` characters of `alphabet`, always the same ones.
class Texts {
 public:
  std::string Any(std::string_view alphabet, unsigned most) {
    std::string text(random_() % (most + 1), ' ');
    for (char& c : text) c = alphabet[random_() % alphabet.size()];
    return text;
  }
  bool Coin() { return random_() % 2 == 0; }

 private:
  std::mt19937 random_{1};
};

TEST(Pattern, MatchesWhatFnmatchMatches) {
  Texts texts;
  int matched = 0;
  for (int i = 0; i < 400000; ++i) {
    const std::string pattern = texts.Any("ab/*?[]!^-\\", 9);
    const std::string text = texts.Any("abc/[]-\\!", 7);
    const bool expected = fnmatch(pattern.c_str(), text.c_str(), 0) == 0;
    ASSERT_EQ(MatchesPattern(pattern, text), expected) << pattern << "  " << text;
    matched += expected;
  }
  EXPECT_GT(matched, 10000) << "the patterns match too little to show anything";
}

TEST(Pattern, ClassesAreThoseOfFnmatch) {
  for (const char* name : {"alpha", "digit", "alnum", "upper", "lower", "space", "blank", "punct",
                           "print", "graph", "cntrl", "xdigit"}) {
    for (const std::string& pattern :
         {"[[:" + std::string(name) + ":]]", "[![:" + std::string(name) + ":]x]"}) {
      for (int c = 1; c < 256; ++c) {
        const std::string text(1, static_cast<char>(c));
        ASSERT_EQ(MatchesPattern(pattern, text), fnmatch(pattern.c_str(), text.c_str(), 0) == 0)
            << pattern << ' ' << c;
      }
    }
  }
}

TEST(Pattern, ManyStarsTakeNoLongerThanTheProductOfTheLengths) {
  std::string pattern;
  for (int i = 0; i < 500; ++i) pattern += "*a";
  EXPECT_FALSE(MatchesPattern(pattern + "b", std::string(20000, 'a')));
  EXPECT_TRUE(MatchesPattern(pattern, std::string(20000, 'a')));
}

TEST(Filter, TheLastRuleThatMatchesDecides) {
  Filter filter(R"(
    SCOREP_REGION_NAMES_BEGIN
      EXCLUDE *                      # all but the solver
      INCLUDE solver::* main
      EXCLUDE solver::dump* MANGLED _Zd*
      INCLUDE DEMANGLED f(int,\ int) operator\[\](*) a\#b \\
    SCOREP_REGION_NAMES_END)");
  EXPECT_EQ(filter.Problem(), "");
  EXPECT_EQ(filter.Of("f()"), FilterAnswer::kExcluded);
  EXPECT_EQ(filter.Of("main"), FilterAnswer::kIncluded);
  EXPECT_EQ(filter.Of("main2"), FilterAnswer::kExcluded);
  EXPECT_EQ(filter.Of("solver::step(int)"), FilterAnswer::kIncluded);
  EXPECT_EQ(filter.Of("solver::step(int)", "_Zds"), FilterAnswer::kExcluded);
  EXPECT_EQ(filter.Of("solver::dump_all(int)"), FilterAnswer::kExcluded);
  for (const char* name : {"f(int, int)", "operator[](unsigned)", "a#b", "\\"})
    EXPECT_EQ(filter.Of(name), FilterAnswer::kIncluded) << name;
}

TEST(Filter, AFunctionGoesWithItsFile) {
  Filter filter(
      "SCOREP_FILE_NAMES_BEGIN EXCLUDE */lib/*\n INCLUDE */lib/own.c SCOREP_FILE_NAMES_END\n"
      "SCOREP_REGION_NAMES_BEGIN INCLUDE f SCOREP_REGION_NAMES_END");
  EXPECT_EQ(filter.Of("g", "g", "src/lib/other.c"), FilterAnswer::kExcluded);
  EXPECT_EQ(filter.Of("f", "f", "src/lib/other.c"), FilterAnswer::kExcluded);
  EXPECT_EQ(filter.Of("f", "f", "src/lib/own.c"), FilterAnswer::kIncluded);
  EXPECT_EQ(filter.Of("g", "g", "src/lib/own.c"), FilterAnswer::kNoRule);
  EXPECT_EQ(filter.Of("g", "g", ""), FilterAnswer::kNoRule) << "a file that is not known";
}

TEST(Filter, IncludingEverythingNamesNothing) {
  Filter filter("SCOREP_REGION_NAMES_BEGIN EXCLUDE f* INCLUDE * SCOREP_REGION_NAMES_END");
  EXPECT_EQ(filter.Of("f"), FilterAnswer::kNoRule);
  EXPECT_EQ(filter.Of("g"), FilterAnswer::kNoRule);
}

TEST(Filter, RulesKnowWhetherTheyMatchedAndWhereTheyStand) {
  Filter filter("SCOREP_REGION_NAMES_BEGIN\nEXCLUDE a* \n b*\nINCLUDE ab\nSCOREP_REGION_NAMES_END");
  ASSERT_EQ(filter.rules.size(), 3u);
  filter.Of("abc");
  EXPECT_TRUE(filter.rules[0].matched);
  EXPECT_FALSE(filter.rules[1].matched);
  EXPECT_FALSE(filter.rules[2].matched);
  EXPECT_EQ(filter.rules[1].line, 3u);
  EXPECT_EQ(filter.rules[1].pattern, "b*");
}

// Filters made of random rules against the rule in words: the last one that matches decides.
TEST(Filter, AgreesWithReadingTheRulesBackwards) {
  Texts texts;
  for (int round = 0; round < 2000; ++round) {
    struct Row {
      bool excludes;
      std::string pattern;
    };
    std::vector<Row> rows;
    std::string text = "SCOREP_REGION_NAMES_BEGIN\n";
    for (int i = 0; i < 6; ++i) {
      rows.push_back({texts.Coin(), texts.Any("ab*", 3) + "a"});
      text += (rows.back().excludes ? "EXCLUDE " : "INCLUDE ") + rows.back().pattern + "\n";
    }
    text += "SCOREP_REGION_NAMES_END\n";
    Filter filter(text);
    const std::string name = texts.Any("ab", 4);
    std::optional<bool> excluded;
    for (auto row = rows.rbegin(); row != rows.rend() && !excluded; ++row)
      if (fnmatch(row->pattern.c_str(), name.c_str(), 0) == 0) excluded = row->excludes;
    EXPECT_EQ(filter.Of(name), !excluded   ? FilterAnswer::kNoRule
                               : *excluded ? FilterAnswer::kExcluded
                                           : FilterAnswer::kIncluded)
        << text << name;
  }
}

TEST(Filter, WhatIsWrongIsSaidWithItsLine) {
  const std::pair<const char*, const char*> rows[] = {
      {"f", "1: 'f' stands outside SCOREP_FILE_NAMES_BEGIN/END and SCOREP_REGION_NAMES_BEGIN/END"},
      {"\n\nEXCLUDE f",
       "3: 'EXCLUDE' stands outside SCOREP_FILE_NAMES_BEGIN/END and SCOREP_REGION_NAMES_BEGIN/END"},
      {"SCOREP_REGION_NAMES_BEGIN\nEXCLUED f",
       "2: 'EXCLUED' stands before any INCLUDE or EXCLUDE of its block"},
      {"SCOREP_FILE_NAMES_BEGIN EXCLUDE\nMANGLED f",
       "2: 'MANGLED' belongs behind INCLUDE or EXCLUDE of a region block"},
      {"SCOREP_FILE_NAMES_BEGIN\nSCOREP_REGION_NAMES_BEGIN",
       "2: 'SCOREP_REGION_NAMES_BEGIN' stands inside another block"},
      {"SCOREP_FILE_NAMES_BEGIN\nSCOREP_REGION_NAMES_END",
       "2: 'SCOREP_REGION_NAMES_END' ends a block that has not begun"},
      {"SCOREP_REGION_NAMES_BEGIN\nEXCLUDE f # SCOREP_REGION_NAMES_END\n",
       "3: 'SCOREP_REGION_NAMES_END' is missing"},
      {"SCOREP_REGION_NAMES_BEGIN\nEXCLUDE f\\\n g SCOREP_REGION_NAMES_END",
       "2: 'f\\' ends in a backslash that escapes nothing"},
      {"# nothing\r\n SCOREP_REGION_NAMES_BEGIN\r\nEXCLUDE f\r\nSCOREP_REGION_NAMES_END\r\n", ""},
      {"", ""},
  };
  for (const auto& [text, problem] : rows) EXPECT_EQ(Filter(text).Problem(), problem) << text;
  const std::string zero = std::string("SCOREP_REGION_NAMES_BEGIN EXCLUDE a") + '\0';
  EXPECT_EQ(std::string_view(Filter(zero).problem.what), "holds a zero byte: this is no text file");
}

// Whatever the text is, it is read within its bounds, and all rules that it has are applied.
TEST(Filter, AnyTextIsSafe) {
  const std::vector<std::string> words = {"SCOREP_REGION_NAMES_BEGIN",
                                          "SCOREP_REGION_NAMES_END",
                                          "SCOREP_FILE_NAMES_BEGIN",
                                          "SCOREP_FILE_NAMES_END",
                                          "EXCLUDE",
                                          "INCLUDE",
                                          "MANGLED",
                                          "#",
                                          "\\",
                                          "\n",
                                          " ",
                                          "[a-",
                                          "*",
                                          "["};
  std::mt19937 random(2);
  for (int round = 0; round < 20000; ++round) {
    std::string text = round % 2 == 0 ? "SCOREP_REGION_NAMES_BEGIN EXCLUDE " : "";
    for (auto i = random() % 12; i > 0; --i) {
      text += words[random() % words.size()];
      if (random() % 2 == 0) text += static_cast<char>(random() % 256);
    }
    // Exactly as long as it is, for a sanitizer to see a byte too many.
    const std::vector<char> bytes(text.begin(), text.end());
    Filter filter(std::string_view(bytes.data(), bytes.size()));
    for (const FilterRule& rule : filter.rules) EXPECT_FALSE(rule.pattern.empty()) << text;
    filter.Of("abc", "[a-", "*");
  }
}

TEST(Filter, DemangledNamesAreNeededForSomeRulesOnly) {
  const auto needs = [](const std::string& rules) {
    const std::string text = "SCOREP_REGION_NAMES_BEGIN " + rules + " SCOREP_REGION_NAMES_END";
    const Filter filter(text);
    return NeedsDemangledNames(filter.rules.data(), filter.rules.size());
  };
  EXPECT_FALSE(needs("EXCLUDE * INCLUDE MANGLED _Z*"));
  EXPECT_TRUE(needs("EXCLUDE * INCLUDE f"));
}

TEST(Filter, FortranNamesAreReadAsPeopleWriteThem) {
  char buffer[64];
  EXPECT_EQ(FilterFortranName("__solver_MOD_step", buffer, sizeof buffer), "solver::step");
  EXPECT_EQ(FilterFortranName("__a_MOD_b_MOD_c", buffer, sizeof buffer), "a::b_MOD_c");
  for (const char* other : {"", "__", "___MOD_", "__MOD_x", "main", "_ZN3fooEv", "x_MOD_y"})
    EXPECT_EQ(FilterFortranName(other, buffer, sizeof buffer), "") << other;
  EXPECT_EQ(FilterFortranName("__solver_MOD_step", buffer, 5), "") << "does not fit";
}

}  // namespace
}  // namespace stipple
