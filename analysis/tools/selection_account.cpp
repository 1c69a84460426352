// SPDX-License-Identifier: MIT
#include "analysis/tools/selection_account.h"

#include <elf.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

#include "analysis/trace/demangle.h"

namespace stipple {
namespace {

constexpr std::string_view kSection = ".stipple_left_out";
constexpr std::string_view kArchive = "!<arch>\n";
constexpr std::string_view kThinArchive = "!<thin>\n";

/// The `count` bytes from `offset` on, if the file has them.
std::optional<std::string_view> Part(std::string_view file, std::uint64_t offset,
                                     std::uint64_t count) {
  if (offset > file.size() || count > file.size() - offset) return std::nullopt;
  return file.substr(offset, count);
}

template <class Struct>
std::optional<Struct> ReadAt(std::string_view file, std::uint64_t offset) {
  const std::optional<std::string_view> part = Part(file, offset, sizeof(Struct));
  if (!part) return std::nullopt;
  Struct value;
  std::memcpy(&value, part->data(), sizeof value);
  return value;
}

/// Up to the zero byte.
std::string_view TextAt(std::string_view texts, std::uint64_t offset) {
  if (offset >= texts.size()) return {};
  const std::string_view rest = texts.substr(offset);
  return rest.substr(0, std::min(rest.find('\0'), rest.size()));
}

bool IsElf(std::string_view file) {
  return file.size() >= sizeof(Elf64_Ehdr) && std::memcmp(file.data(), ELFMAG, SELFMAG) == 0 &&
         file[EI_CLASS] == ELFCLASS64 && file[EI_DATA] == ELFDATA2LSB;
}

/// The contents of all sections of our name.
std::vector<std::string_view> AccountSections(std::string_view file) {
  const auto header = ReadAt<Elf64_Ehdr>(file, 0);
  if (!header || header->e_shentsize != sizeof(Elf64_Shdr)) return {};
  const auto section_at = [&](std::uint64_t index) -> std::optional<Elf64_Shdr> {
    if (index > file.size() / sizeof(Elf64_Shdr) || header->e_shoff > file.size()) return {};
    return ReadAt<Elf64_Shdr>(file, header->e_shoff + index * sizeof(Elf64_Shdr));
  };
  // Where the header's fields are too small, section 0 has the numbers.
  const auto first = section_at(0);
  if (!first) return {};
  const std::uint64_t count = header->e_shnum != 0 ? header->e_shnum : first->sh_size;
  const auto names =
      section_at(header->e_shstrndx != SHN_XINDEX ? header->e_shstrndx : first->sh_link);
  const auto texts = names ? Part(file, names->sh_offset, names->sh_size) : std::nullopt;
  std::vector<std::string_view> sections;
  for (std::uint64_t i = 1; texts && i < count; ++i) {
    const auto section = section_at(i);
    if (!section) break;
    if (TextAt(*texts, section->sh_name) != kSection || section->sh_type == SHT_NOBITS) continue;
    if (const auto part = Part(file, section->sh_offset, section->sh_size))
      sections.push_back(*part);
  }
  return sections;
}

/// The fields of one text, without their escapes.
std::vector<std::string> FieldsOf(std::string_view text) {
  std::vector<std::string> fields(1);
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\t') {
      fields.emplace_back();
    } else if (text[i] == '\\' && i + 1 < text.size()) {
      const char c = text[++i];
      fields.back() += c == 't' ? '\t' : c == 'n' ? '\n' : c == '0' ? '\0' : c;
    } else {
      fields.back() += text[i];
    }
  }
  return fields;
}

void AddText(std::string_view text, SelectionAccount& account) {
  std::vector<std::string> f = FieldsOf(text);
  if (f[0] == "in:" && f.size() == 2) {
    account.instrumented.insert(f[1]);
  } else if (f[0] == "out:" && f.size() == 6) {
    account.left_out.try_emplace(f[1], LeftOutFunction{f[2], f[3], f[5], f[4]});
  } else if (f[0] == "rule:" && f.size() == 4) {
    account.rules[{f[1], f[2]}] |= f[3] == "matched";
  }
}

void AddElf(std::string_view file, SelectionAccount& account) {
  for (std::string_view section : AccountSections(file)) {
    while (!section.empty()) {
      const std::string_view text = TextAt(section, 0);
      AddText(text, account);
      section.remove_prefix(std::min(section.size(), text.size() + 1));
    }
  }
}

/// Members stand one behind the other, each behind a header of 60 characters.
void AddArchive(std::string_view file, SelectionAccount& account) {
  constexpr std::uint64_t kHeaderBytes = 60, kSizeAt = 48, kSizeBytes = 10;
  for (std::uint64_t at = kArchive.size(); at + kHeaderBytes <= file.size();) {
    const std::string_view size_text = file.substr(at + kSizeAt, kSizeBytes);
    std::uint64_t size = 0;
    if (std::from_chars(size_text.data(), size_text.data() + kSizeBytes, size).ec != std::errc())
      return;
    at += kHeaderBytes;
    const auto member = Part(file, at, size);
    if (!member) return;
    if (IsElf(*member)) AddElf(*member, account);
    at += size + size % 2;
  }
}

std::string Where(const LeftOutFunction& f) {
  if (f.file.empty()) return "?";
  return f.line == "0" ? f.file : f.file + ":" + f.line;
}

std::string Headline(std::size_t instrumented, std::size_t left_out,
                     const std::map<std::string, std::size_t>& by_reason) {
  std::vector<std::pair<std::string, std::size_t>> reasons(by_reason.begin(), by_reason.end());
  std::ranges::stable_sort(reasons, std::greater<>(), &std::pair<std::string, std::size_t>::second);
  std::string text =
      fmt::format("{} of {} functions are instrumented; ", instrumented, instrumented + left_out);
  if (left_out == 0) return text + "none was left out\n";
  text += fmt::format("{} left out", left_out);
  const char* separator = ": ";
  for (const auto& [reason, count] : reasons) {
    text += fmt::format("{}{} {}", separator, count, reason);
    separator = ", ";
  }
  return text + "\n";
}

std::string RulesWithoutEffect(const SelectionAccount& account) {
  std::string text;
  for (const auto& [rule, matched] : account.rules)
    if (!matched) text += fmt::format("  {}  {}\n", rule.first, rule.second);
  return text.empty() ? text : "\nRules that match no function:\n" + text;
}

}  // namespace

AccountProblem ReadAccount(std::span<const std::byte> bytes, SelectionAccount& account) {
  const std::string_view file(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (file.starts_with(kThinArchive)) return AccountProblem::kThinArchive;
  if (file.starts_with(kArchive)) {
    AddArchive(file, account);
  } else if (IsElf(file)) {
    AddElf(file, account);
  } else {
    return AccountProblem::kNotElf;
  }
  for (const std::string& identity : account.instrumented) account.left_out.erase(identity);
  return AccountProblem::kNone;
}

std::string Explain(const SelectionAccount& account) {
  std::map<std::string, std::size_t> by_reason;
  struct Row {
    std::string reason, name, where;
    auto operator<=>(const Row&) const = default;
  };
  std::vector<Row> rows;
  std::size_t width = 0;
  for (const auto& [identity, f] : account.left_out) {
    ++by_reason[f.reason];
    rows.push_back({f.reason, Demangle(f.name), Where(f)});
    width = std::max(width, f.reason.size());
  }
  std::ranges::sort(rows);
  std::string text = Headline(account.instrumented.size(), rows.size(), by_reason);
  if (!rows.empty()) text += "\n";
  for (const Row& row : rows)
    text += fmt::format("  {:<{}}  {}  {}\n", row.reason, width, row.name, row.where);
  return text + RulesWithoutEffect(account);
}

}  // namespace stipple
