// SPDX-License-Identifier: MIT
// The account of the selection, read from files made here: what the plugins write is tested with
// them (tests/apps/wrappers.sh).
#include "analysis/tools/selection_account.h"

#include <elf.h>
#include <gtest/gtest.h>

#include <cstring>
#include <random>

namespace stipple {
namespace {

std::span<const std::byte> Bytes(const std::string& text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

template <class Struct>
std::string Raw(const Struct& value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

/// An ELF file with one section of these strings. With `extended`, the header leaves the numbers of
/// sections to section 0, as files with very many do.
std::string Elf(std::string_view content, bool extended = false) {
  const std::string names = std::string("\0.stipple_left_out\0", 19);
  Elf64_Ehdr header = {};
  std::memcpy(header.e_ident, ELFMAG, SELFMAG);
  header.e_ident[EI_CLASS] = ELFCLASS64;
  header.e_ident[EI_DATA] = ELFDATA2LSB;
  header.e_shentsize = sizeof(Elf64_Shdr);
  header.e_shoff = sizeof header + content.size() + names.size();
  Elf64_Shdr sections[3] = {};
  sections[1].sh_name = 1;
  sections[1].sh_type = SHT_PROGBITS;
  sections[1].sh_offset = sizeof header;
  sections[1].sh_size = content.size();
  sections[2].sh_type = SHT_STRTAB;
  sections[2].sh_offset = sizeof header + content.size();
  sections[2].sh_size = names.size();
  if (extended) {
    header.e_shstrndx = SHN_XINDEX;
    sections[0].sh_size = 3;
    sections[0].sh_link = 2;
  } else {
    header.e_shnum = 3;
    header.e_shstrndx = 2;
  }
  return Raw(header) + std::string(content) + names + Raw(sections);
}

std::string Member(const std::string& content) {
  char header[61];
  std::snprintf(header, sizeof header, "%-48s%-10zu`\n", "member.o/", content.size());
  return header + content + (content.size() % 2 != 0 ? "\n" : "");
}

std::string Explained(const std::string& file) {
  SelectionAccount account;
  EXPECT_EQ(ReadAccount(Bytes(file), account), AccountProblem::kNone);
  return Explain(account);
}

/// A section of these strings.
std::string Strings(std::initializer_list<std::string_view> texts) {
  std::string section;
  for (const std::string_view text : texts) section.append(text) += '\0';
  return section;
}

const std::string kOne =
    Strings({"in:\t01", "out:\t02\ttrivial\t_Z1fi\t7\ta.cpp", "out:\t03\tsystem header\tg\t0\t",
             "rule:\tx.filter:3\tf*\tmatched", "rule:\tx.filter:4\tnone\tunmatched"});

TEST(LeftOut, IsASentenceASortedTableAndTheRulesWithoutEffect) {
  for (const bool extended : {false, true}) {
    EXPECT_EQ(Explained(Elf(kOne, extended)),
              "1 of 3 functions are instrumented; 2 left out: 1 system header, 1 trivial\n"
              "\n"
              "  system header  g  ?\n"
              "  trivial        f(int)  a.cpp:7\n"
              "\n"
              "Rules that match no function:\n"
              "  x.filter:4  none\n");
  }
  EXPECT_EQ(Explained(Elf(Strings({"in:\t01"}))),
            "1 of 1 functions are instrumented; none was left out\n");
}

TEST(LeftOut, AFunctionCountsOnceAndARuleThatMatchedAnywhereMatched) {
  const std::string other = Elf(
      Strings({"in:\t02", "out:\t03\tsystem header\tg\t0\t", "rule:\tx.filter:4\tnone\tmatched"}));
  EXPECT_EQ(Explained("!<arch>\n" + Member(Elf(kOne)) + Member("no ELF") + Member(other)),
            "2 of 3 functions are instrumented; 1 left out: 1 system header\n"
            "\n"
            "  system header  g  ?\n");
}

TEST(LeftOut, EscapesAreUndone) {
  const std::string file = Elf(Strings({"out:\t01\ttrivial\tf\t1\ta\\tb\\\\c\\nd"}));
  EXPECT_NE(Explained(file).find("a\tb\\c\nd:1"), std::string::npos);
}

TEST(LeftOut, OtherFilesAreRefused) {
  SelectionAccount account;
  EXPECT_EQ(ReadAccount(Bytes(""), account), AccountProblem::kNotElf);
  EXPECT_EQ(ReadAccount(Bytes("int main() {}"), account), AccountProblem::kNotElf);
  EXPECT_EQ(ReadAccount(Bytes("!<thin>\n"), account), AccountProblem::kThinArchive);
  EXPECT_EQ(ReadAccount(Bytes(Elf("")), account), AccountProblem::kNone);
  EXPECT_TRUE(account.empty());
}

// Whatever is damaged, reading stays within the file: the sanitizers' builds would tell.
TEST(LeftOut, DamageIsSkipped) {
  std::mt19937 random(3);
  const std::string good[] = {Elf(kOne), Elf(kOne, true),
                              "!<arch>\n" + Member(Elf(kOne)) + Member(Elf(kOne, true))};
  std::size_t still_read = 0;
  for (int round = 0; round < 30000; ++round) {
    std::string file = good[round % 3];
    for (int i = 0; i < 3; ++i) {
      // Headers and section headers matter most; all ones and small numbers are the likely traps.
      const std::size_t at = random() % 2 == 0
                                 ? random() % file.size()
                                 : file.size() - 1 - random() % (3 * sizeof(Elf64_Shdr));
      const int kind = static_cast<int>(random() % 3);
      file[at] = static_cast<char>(kind == 0 ? 0xff : kind == 1 ? random() % 8 : random());
    }
    if (random() % 4 == 0) file.resize(random() % file.size());
    const std::vector<char> exact(file.begin(), file.end());
    SelectionAccount account;
    ReadAccount(std::as_bytes(std::span(exact)), account);
    Explain(account);
    still_read += !account.empty();
  }
  EXPECT_GT(still_read, 1000u) << "the damage hides everything";
}

}  // namespace
}  // namespace stipple
