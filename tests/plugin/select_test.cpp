// SPDX-License-Identifier: MIT
#include "plugin/select/select.h"

#include <gtest/gtest.h>

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

Reason ReasonFor(const FunctionFacts& facts, const Options& options) {
  return Select(facts, options).reason;
}

TEST(Select, TrivialMeansShortAndWithoutLoopAndWithoutCall) {
  const Options options;
  for (const unsigned instructions : {19u, 20u}) {
    for (const bool loop : {false, true}) {
      for (const bool calls : {false, true}) {
        FunctionFacts facts = Work();
        facts.instructions = instructions;
        facts.has_loop = loop;
        facts.makes_calls = calls;
        EXPECT_EQ(Select(facts, options).instrument, instructions >= 20 || loop || calls);
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
  EXPECT_TRUE(Select(facts, options).instrument);
  options.exclude_functions = {"_ZN8geometry"};  // the linkage name matches too
  EXPECT_FALSE(Select(facts, options).instrument);
  options.exclude_functions.clear();
  facts.instructions = 1;
  options.include_functions = {"Intersect(Ray"};
  EXPECT_TRUE(Select(facts, options).instrument);
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
  EXPECT_EQ(options.position, Position::kSource);
  EXPECT_EQ(*SetOption(options, "threshold", "7"),
            "stipple: unknown option 'threshold'; known are exclude-function-list, "
            "exclude-file-list, include-function-list, instruction-threshold, instrument");
  for (const char* value : {"", "-1", "7x", "99999999999"}) {
    EXPECT_EQ(*SetOption(options, "instruction-threshold", value),
              "stipple: option instruction-threshold cannot be '" + std::string(value) +
                  "'; it takes a number of instructions");
  }
  EXPECT_EQ(*SetOption(options, "instrument", "before"),
            "stipple: option instrument cannot be 'before'; it takes after-inlining or source");
}

}  // namespace
}  // namespace stipple::plugin
