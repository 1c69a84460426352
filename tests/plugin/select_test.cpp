// SPDX-License-Identifier: MIT
#include "plugin/select/select.h"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>

namespace stipple::plugin {
namespace {

FunctionFacts Work() {
  FunctionFacts facts;
  facts.name = "geometry::Bvh::Intersect(Ray const&)";
  facts.linkage_name = "_ZN8geometry3Bvh9IntersectERK3Ray";
  facts.file = "src/geometry/bvh.cpp";
  facts.instructions = 100;
  return facts;
}

Answer AnswerFor(const FunctionFacts& facts, const Options& options) {
  Selection selection(options);
  EXPECT_EQ(selection.ReadFilterFile(), std::nullopt);
  return selection.Select(facts);
}

Reason ReasonFor(const FunctionFacts& facts, const Options& options) {
  return AnswerFor(facts, options).reason;
}

/// A file with this text, gone with the object.
class TextFile {
 public:
  explicit TextFile(std::string_view text)
      : path_(::testing::TempDir() + "stipple_select_test.XXXXXX") {
    const int file = mkstemp(path_.data());
    EXPECT_EQ(write(file, text.data(), text.size()), static_cast<ssize_t>(text.size()));
    close(file);
  }
  ~TextFile() { unlink(path_.c_str()); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

bool Says(const std::set<std::string>& account, std::string_view start) {
  return std::ranges::any_of(account, [&](const std::string& s) { return s.starts_with(start); });
}

TEST(Select, TrivialMeansShortAndWithoutLoopAndWithoutCall) {
  Options options;
  for (const bool ignore_loops : {false, true}) {
    options.ignore_loops = ignore_loops;
    for (const unsigned instructions : {19u, 20u}) {
      for (const bool loop : {false, true}) {
        for (const bool calls : {false, true}) {
          FunctionFacts facts = Work();
          facts.instructions = instructions;
          facts.has_loop = loop;
          facts.makes_calls = calls;
          EXPECT_EQ(AnswerFor(facts, options).instrument,
                    instructions >= 20 || (loop && !ignore_loops) || calls);
        }
      }
    }
  }
}

// Each row adds one fact or option to those above it, and is stronger than all of them.
TEST(Select, AStrongerRuleDecides) {
  FunctionFacts facts = Work();
  Options options;
  EXPECT_EQ(ReasonFor(facts, options), Reason::kDefault);
  facts.instructions = 1;
  EXPECT_EQ(ReasonFor(facts, options), Reason::kTrivial);
  facts.in_system_header = true;
  EXPECT_EQ(ReasonFor(facts, options), Reason::kSystemHeader);
  const TextFile include("SCOREP_REGION_NAMES_BEGIN INCLUDE *Bvh* SCOREP_REGION_NAMES_END");
  options.filter_file = include.path();
  EXPECT_EQ(ReasonFor(facts, options), Reason::kFilterIncluded);
  const TextFile exclude("SCOREP_REGION_NAMES_BEGIN EXCLUDE *Bvh* SCOREP_REGION_NAMES_END");
  options.filter_file = exclude.path();
  EXPECT_EQ(ReasonFor(facts, options), Reason::kFilterExcluded);
  options.exclude_files = {"geometry/"};
  EXPECT_EQ(ReasonFor(facts, options), Reason::kExcludedFile);
  options.include_functions = {"Bvh::"};
  EXPECT_EQ(ReasonFor(facts, options), Reason::kIncludedFunction);
  facts.wish = Wish::kAlways;
  EXPECT_EQ(ReasonFor(facts, options), Reason::kAttributeAlways);
  options.exclude_functions = {"Intersect"};
  EXPECT_EQ(ReasonFor(facts, options), Reason::kExcludedFunction);
  facts.artificial = true;
  EXPECT_EQ(ReasonFor(facts, options), Reason::kArtificial);
  facts.wish = Wish::kNever;
  EXPECT_EQ(ReasonFor(facts, options), Reason::kAttributeNever);
}

TEST(Select, OnlyTheseReasonsInstrument) {
  FunctionFacts facts = Work();
  Options options;
  EXPECT_TRUE(AnswerFor(facts, options).instrument);
  options.exclude_functions = {"_ZN8geometry"};  // the linkage name matches too
  EXPECT_FALSE(AnswerFor(facts, options).instrument);
  options.exclude_functions.clear();
  facts.instructions = 1;
  options.include_functions = {"Intersect(Ray"};
  EXPECT_TRUE(AnswerFor(facts, options).instrument);
}

TEST(Select, WhatTheCompilerMadeAndWhatStandsInStdIsLeftOut) {
  for (const char* name : {"_ZThn16_N1A1fEv", "_ZTW1x", "_GLOBAL__sub_I_main.cpp", "__tcf_0",
                           "__cxx_global_var_init", "__clang_call_terminate"}) {
    FunctionFacts facts = Work();
    facts.linkage_name = name;
    EXPECT_EQ(ReasonFor(facts, {}), Reason::kArtificial) << name;
  }
  for (const char* name : {"_ZNSt6vectorIiSaIiEE9push_backERKi", "_ZSt4sortIPiEvT_S1_",
                           "_ZN9__gnu_cxx13new_allocatorIiE8allocateEmPKv"}) {
    FunctionFacts facts = Work();
    facts.linkage_name = name;
    EXPECT_EQ(ReasonFor(facts, {}), Reason::kSystemHeader) << name;
  }
}

TEST(Select, ManualEventsOfFortranAreNone) {
  FunctionFacts facts = Work();
  facts.linkage_name = "__stipple_MOD_stipple_mark";
  EXPECT_EQ(ReasonFor(facts, {}), Reason::kAttributeNever);
  facts.linkage_name = "__stipple2_MOD_mark";
  EXPECT_EQ(ReasonFor(facts, {}), Reason::kDefault);
}

TEST(Select, SystemHeadersAreTakenWhenAskedFor) {
  Options options;
  options.system_headers = true;
  FunctionFacts facts = Work();
  facts.in_system_header = true;
  EXPECT_EQ(ReasonFor(facts, options), Reason::kDefault);
  facts.linkage_name = "_ZSt4sortIPiEvT_S1_";
  EXPECT_EQ(ReasonFor(facts, options), Reason::kDefault);
}

TEST(Filter, NamesAreThoseThatPeopleSeeAndMangledOnesTheLinkers) {
  const TextFile file(
      "SCOREP_FILE_NAMES_BEGIN EXCLUDE */generated/* SCOREP_FILE_NAMES_END\n"
      "SCOREP_REGION_NAMES_BEGIN EXCLUDE * INCLUDE geometry::*(Ray\\ const&) solver::*\n"
      "INCLUDE MANGLED _Z4work* SCOREP_REGION_NAMES_END");
  Options options;
  options.filter_file = file.path();
  const auto instruments = [&](const char* name, const char* linkage, const char* source) {
    FunctionFacts facts = Work();
    facts.name = name;
    facts.linkage_name = linkage;
    facts.file = source;
    return AnswerFor(facts, options).instrument;
  };
  EXPECT_TRUE(instruments("geometry::Hit(Ray const&)", "_ZN8geometry3HitERK3Ray", "a.cpp"));
  EXPECT_FALSE(instruments("geometry::Hit(Ray)", "_ZN8geometry3HitE3Ray", "a.cpp"));
  EXPECT_TRUE(instruments("work(int)", "_Z4worki.constprop.0", "a.cpp"));
  EXPECT_TRUE(instruments("__solver_MOD_step", "__solver_MOD_step", "solver.f90")) << "Fortran";
  EXPECT_FALSE(instruments("work(int)", "_Z4worki", "src/generated/a.cpp"));
}

TEST(Filter, WhatIsWrongWithTheFileIsOneLine) {
  Options options;
  Selection selection(options);
  options.filter_file = "/no/such.filter";
  EXPECT_EQ(selection.ReadFilterFile(),
            "stipple: filter-file /no/such.filter: No such file or directory");
  options.filter_file = "/";
  EXPECT_EQ(selection.ReadFilterFile(), "stipple: filter-file /: Is a directory");
  const TextFile broken("SCOREP_REGION_NAMES_BEGIN\n  EXCLUED f\nSCOREP_REGION_NAMES_END\n");
  options.filter_file = broken.path();
  EXPECT_EQ(selection.ReadFilterFile(),
            broken.path() + ":2: 'EXCLUED' stands before any INCLUDE or EXCLUDE of its block");
}

TEST(Account, SaysWhatWasLeftOutAndWhyAndWhatMatched) {
  const TextFile file("SCOREP_REGION_NAMES_BEGIN EXCLUDE nothing* SCOREP_REGION_NAMES_END");
  Options options;
  options.filter_file = file.path();
  options.exclude_functions = {"Bvh", "none"};
  Selection selection(options);
  ASSERT_EQ(selection.ReadFilterFile(), std::nullopt);
  EXPECT_TRUE(selection.Account().empty()) << "no function, no account";
  FunctionFacts facts = Work();
  facts.line = 7;
  facts.file = "src/a\tb\\.cpp";
  selection.Select(facts);
  facts.linkage_name = "_ZN5other4workEv";
  facts.name = "other::work()";
  selection.Select(facts);
  const std::set<std::string>& account = selection.Account();
  EXPECT_EQ(account.size(), 5u);
  EXPECT_TRUE(Says(account, "in:\t"));
  EXPECT_EQ(std::ranges::count_if(
                account,
                [](const std::string& s) {
                  return s.ends_with(
                      "\tnamed by exclude-function-list\t_ZN8geometry3Bvh9IntersectERK3Ray"
                      "\t7\tsrc/a\\tb\\\\.cpp");
                }),
            1);
  EXPECT_TRUE(account.contains("rule:\texclude-function-list\tBvh\tmatched"));
  EXPECT_TRUE(account.contains("rule:\texclude-function-list\tnone\tunmatched"));
  EXPECT_TRUE(account.contains("rule:\t" + file.path() + ":1\tnothing*\tunmatched"));
}

TEST(Account, TheSameFunctionIsTheSameWhicheverCloneIsSeen) {
  Options options;
  Selection selection(options);
  FunctionFacts facts = Work();
  selection.Select(facts);
  facts.linkage_name += ".part.0";
  selection.Select(facts);
  EXPECT_EQ(selection.Account().size(), 1u);
}

TEST(Note, IsGivenWhenNothingOfAllThatWasAskedForMatches) {
  Options options;
  options.exclude_functions = {"none"};
  options.include_functions = {"nobody"};
  Selection selection(options);
  EXPECT_EQ(selection.Note(), "") << "no function, no note";
  selection.Select(Work());
  EXPECT_EQ(selection.Note(), "stipple: note: nothing in this file matches none, nobody");
  FunctionFacts facts = Work();
  facts.name = "nobody()";
  facts.wish = Wish::kNever;
  selection.Select(facts);
  EXPECT_EQ(selection.Note(), "") << "an entry that a stronger rule overrules is no mistake";
}

TEST(CloneSuffix, IsTakenOffUnlessTheCloneIsCodeOfItsOwn) {
  EXPECT_EQ(WithoutCloneSuffix("_Z1fi"), "_Z1fi");
  EXPECT_EQ(WithoutCloneSuffix("_Z1fi.constprop.0"), "_Z1fi");
  EXPECT_EQ(WithoutCloneSuffix("_Z5Counti.resume"), "_Z5Counti");
  EXPECT_EQ(WithoutCloneSuffix("sum.avx2"), "sum");
  EXPECT_EQ(WithoutCloneSuffix("main._omp_fn.0"), "main._omp_fn.0");
  EXPECT_EQ(WithoutCloneSuffix(".omp_outlined."), ".omp_outlined.");
}

TEST(Options, ListsSplitAtCommasThatAreNotEscaped) {
  EXPECT_EQ(SplitList("a,b"), (NameList{"a", "b"}));
  EXPECT_EQ(SplitList("f(int\\,int),g"), (NameList{"f(int,int)", "g"}));
  EXPECT_EQ(SplitList(",a,,"), (NameList{"a"}));
  EXPECT_TRUE(SplitList("").empty());
}

TEST(Options, AWrongNameOrValueIsAnsweredWithTheRightOnes) {
  Options options;
  EXPECT_FALSE(SetOption(options, "instruction-threshold", "7"));
  EXPECT_EQ(options.instruction_threshold, 7u);
  EXPECT_FALSE(SetOption(options, "instrument", "source"));
  for (const char* value : {"on", "off", ""}) {
    EXPECT_FALSE(SetOption(options, "ignore-loops", value));
    EXPECT_EQ(options.ignore_loops, std::string_view(value) != "off");
  }
  EXPECT_FALSE(SetOption(options, "exceptions", "off"));
  EXPECT_FALSE(options.exceptions);
  EXPECT_FALSE(SetOption(options, "tail-calls", "exit-after"));
  EXPECT_FALSE(options.tail_calls_preserved);
  EXPECT_EQ(*SetOption(options, "system-headers", "yes"),
            "stipple: option system-headers cannot be 'yes'; it takes on or off");
  EXPECT_EQ(options.position, Position::kSource);
  EXPECT_EQ(*SetOption(options, "threshold", "7"),
            "stipple: unknown option 'threshold'; known are exclude-function-list, "
            "exclude-file-list, include-function-list, filter-file, instruction-threshold, "
            "ignore-loops, system-headers, exceptions, tail-calls, instrument");
  for (const char* value : {"", "-1", "7x", "99999999999"}) {
    EXPECT_EQ(*SetOption(options, "instruction-threshold", value),
              "stipple: option instruction-threshold cannot be '" + std::string(value) +
                  "'; it takes a number of instructions");
  }
  EXPECT_EQ(*SetOption(options, "instrument", "before"),
            "stipple: option instrument cannot be 'before'; it takes after-inlining or source");
}

// docs/plugin-options.md shows the table of the options as it is.
TEST(Options, TheDocumentationHasTheirTable) {
  std::ifstream in(STIPPLE_SOURCE_DIR "/docs/plugin-options.md");
  const std::string page(std::istreambuf_iterator<char>(in), {});
  EXPECT_NE(page.find(OptionTable()), std::string::npos) << "the table should be:\n"
                                                         << OptionTable();
}

}  // namespace
}  // namespace stipple::plugin
