// SPDX-License-Identifier: MIT
#include "analysis/trace/symbols.h"

#include <dwarf.h>
#include <elfutils/libdw.h>
#include <elfutils/libdwfl.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/trace/demangle.h"

namespace stipple {
namespace {

struct Symbol {
  std::string linkage_name;
  std::string file;  // empty: no debug information
  std::uint32_t line = 0;
};

/// A file of code, opened for its symbols.
class SymbolFile {
 public:
  SymbolFile(const std::string& path, std::string_view build_id)
      : session_(dwfl_begin(&kCallbacks), &dwfl_end) {
    // The path is what the archive says: it may be that of something that blocks when opened.
    std::error_code error;
    if (!session_ || !std::filesystem::is_regular_file(path, error)) return;
    dwfl_report_begin(session_.get());
    module_ = dwfl_report_offline(session_.get(), "", path.c_str(), -1);
    dwfl_report_end(session_.get(), nullptr, nullptr);
    // The build-id is known once the file has been opened.
    if (module_ != nullptr && dwfl_module_getelf(module_, &bias_) == nullptr) module_ = nullptr;
    if (module_ != nullptr && BuildId() != build_id) module_ = nullptr;
  }

  /// The function that begins at `offset`, counted as the file does.
  std::optional<Symbol> At(std::uint64_t offset) {
    if (module_ == nullptr) return std::nullopt;
    GElf_Off distance = 0;
    GElf_Sym symbol;
    const char* name = dwfl_module_addrinfo(module_, offset + bias_, &distance, &symbol, nullptr,
                                            nullptr, nullptr);
    if (name == nullptr || distance != 0) return std::nullopt;
    Symbol found{name, "", 0};
    FindLine(offset, found);
    return found;
  }

  /// The functions whose code is at `offset`, the innermost of those that were inlined there first,
  /// each with the line where it was at. Empty: not known.
  std::vector<Symbol> Around(std::uint64_t offset) {
    if (module_ == nullptr) return {};
    const char* name = dwfl_module_addrname(module_, offset + bias_);
    if (name == nullptr) return {};
    Symbol place{"", "", 0};
    FindLine(offset, place);
    std::vector<Symbol> found;
    const Piece* piece = PieceAt(offset + bias_);
    Dwarf_Die* scopes = nullptr;
    const int count =
        piece == nullptr ? 0 : dwarf_getscopes(piece->unit, offset + bias_ - piece->bias, &scopes);
    for (int i = 0; i < count; ++i) {
      if (dwarf_tag(scopes + i) == DW_TAG_subprogram) break;
      if (dwarf_tag(scopes + i) != DW_TAG_inlined_subroutine) continue;
      found.push_back(place);
      found.back().linkage_name = LinkageName(scopes + i);
      place = CallPlace(piece->unit, scopes + i);
    }
    std::free(scopes);
    place.linkage_name = name;
    // "exp@@GLIBC_2.29": the version says nothing about where time went.
    place.linkage_name.resize(std::min(place.linkage_name.size(), place.linkage_name.find('@')));
    found.push_back(std::move(place));
    return found;
  }

 private:
  void FindLine(std::uint64_t offset, Symbol& found) {
    Dwarf_Line* row = RowAt(offset + bias_);
    int line = 0;
    const char* file = row == nullptr ? nullptr : dwarf_linesrc(row, nullptr, nullptr);
    if (file == nullptr || dwarf_lineno(row, &line) != 0) return;
    found.file = file;
    found.line = static_cast<std::uint32_t>(line);
  }

  static std::string LinkageName(Dwarf_Die* function) {
    Dwarf_Attribute attribute;
    for (const unsigned which : {unsigned{DW_AT_linkage_name}, unsigned{DW_AT_name}})
      if (const char* text = dwarf_formstring(dwarf_attr_integrate(function, which, &attribute)))
        return text;
    return "(inlined)";
  }

  /// Where an inlined function was called.
  static Symbol CallPlace(Dwarf_Die* unit, Dwarf_Die* function) {
    Symbol place{"", "", 0};
    Dwarf_Attribute attribute;
    Dwarf_Word file = 0;
    Dwarf_Word line = 0;
    Dwarf_Files* files = nullptr;
    std::size_t count = 0;
    if (dwarf_formudata(dwarf_attr(function, DW_AT_call_file, &attribute), &file) != 0 ||
        dwarf_formudata(dwarf_attr(function, DW_AT_call_line, &attribute), &line) != 0 ||
        dwarf_getsrcfiles(unit, &files, &count) != 0 || file >= count)
      return place;
    if (const char* path = dwarf_filesrc(files, file, nullptr, nullptr)) place.file = path;
    place.line = static_cast<std::uint32_t>(line);
    return place;
  }

  std::string_view BuildId() const {
    const unsigned char* bytes = nullptr;
    GElf_Addr address = 0;
    const int count = dwfl_module_build_id(module_, &bytes, &address);
    if (count <= 0) return {};
    return {reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(count)};
  }

  /// A piece of code and the unit that it was compiled in.
  struct Piece {
    Dwarf_Addr begin, end;
    Dwarf_Die* unit;
    Dwarf_Addr bias;
  };

  // By its own index: elfutils' look-up by address needs a section that clang does not write.
  const Piece* PieceAt(Dwarf_Addr address) {
    if (!indexed_) IndexUnits();
    auto piece = std::ranges::upper_bound(pieces_, address, {}, &Piece::begin);
    return piece == pieces_.begin() || address >= (--piece)->end ? nullptr : &*piece;
  }
  Dwarf_Line* RowAt(Dwarf_Addr address) {
    const Piece* piece = PieceAt(address);
    return piece == nullptr ? nullptr : dwarf_getsrc_die(piece->unit, address - piece->bias);
  }

  void IndexUnits() {
    indexed_ = true;
    Dwarf_Addr bias = 0;
    for (Dwarf_Die* unit = nullptr; (unit = dwfl_module_nextcu(module_, unit, &bias)) != nullptr;) {
      Dwarf_Addr base = 0;
      Dwarf_Addr begin = 0;
      Dwarf_Addr end = 0;
      for (std::ptrdiff_t at = 0; (at = dwarf_ranges(unit, at, &base, &begin, &end)) > 0;)
        pieces_.push_back({begin + bias, end + bias, unit, bias});
    }
    std::ranges::sort(pieces_, {}, &Piece::begin);
  }

  static constexpr Dwfl_Callbacks kCallbacks = {nullptr, &dwfl_standard_find_debuginfo,
                                                &dwfl_offline_section_address, nullptr};
  std::unique_ptr<Dwfl, decltype(&dwfl_end)> session_;
  Dwfl_Module* module_ = nullptr;
  GElf_Addr bias_ = 0;
  bool indexed_ = false;
  std::vector<Piece> pieces_;  // by begin
};

}  // namespace

/// Each file is opened once and each address looked up once, however many processes used them.
class SymbolCache {
 public:
  /// Null: it has none.
  const Symbol* Find(const ModuleDefinition& module, std::uint64_t offset, TraceHealth& health) {
    Entry& entry = EntryOf(module);
    const auto [at, is_new] = entry.symbols.try_emplace(offset);
    if (is_new) {
      at->second = entry.file.At(offset);
      if (!at->second) health.Add(Defect::kUnnamedFunction, module.path);
    }
    return at->second ? &*at->second : nullptr;
  }

  std::vector<Symbol> Around(const ModuleDefinition& module, std::uint64_t offset) {
    return EntryOf(module).file.Around(offset);
  }

 private:
  struct Entry {
    SymbolFile file;
    std::map<std::uint64_t, std::optional<Symbol>> symbols;
  };

  Entry& EntryOf(const ModuleDefinition& module) {
    const std::pair<std::string, std::string> key(module.path, module.build_id);
    if (const auto known = entries_.find(key); known != entries_.end()) return *known->second;
    auto entry = std::make_unique<Entry>(Entry{SymbolFile(key.first, key.second), {}});
    return *entries_.emplace(key, std::move(entry)).first->second;
  }

  std::map<std::pair<std::string, std::string>, std::unique_ptr<Entry>> entries_;
};

void NameCode(std::span<const std::unique_ptr<Stream>> streams, TraceHealth& health) {
  SymbolCache cache;
  for (const auto& stream : streams) {
    if (stream->code.empty()) continue;
    std::map<std::uint32_t, const ModuleDefinition*> modules;
    for (const ModuleDefinition& m : stream->modules) modules.emplace(m.module, &m);
    std::map<std::uint32_t, RegionDefinition*> regions;
    for (RegionDefinition& r : stream->regions) regions.emplace(r.region, &r);
    for (const CodeDefinition& c : stream->code) {
      const auto module = modules.find(c.module);
      const auto region = regions.find(c.region);
      if (module == modules.end() || region == regions.end()) {
        health.Add(Defect::kBadDefinition, stream->file_name);
        continue;
      }
      const Symbol* symbol = cache.Find(*module->second, c.offset, health);
      if (symbol == nullptr) continue;
      region->second->linkage_name = stream->symbol_texts.emplace_back(symbol->linkage_name);
      if (symbol->file.empty()) continue;
      region->second->file = stream->symbol_texts.emplace_back(symbol->file);
      region->second->line = symbol->line;
    }
  }
}

FrameNames::FrameNames() : cache_(std::make_unique<SymbolCache>()) {}
FrameNames::~FrameNames() = default;

const std::vector<FrameName>& FrameNames::Of(const Stream& stream, std::uint64_t frame,
                                             bool is_return) {
  // A call that does not return may be the last instruction of its function: its return address
  // belongs to another one.
  const std::uint64_t address = is_return ? frame - 1 : frame;
  std::vector<FrameName>& names = names_[{&stream, address}];
  if (!names.empty()) return names;
  const auto number = static_cast<std::uint32_t>(frame >> kFrameModuleShift);
  const auto module = std::ranges::find(stream.modules, number, &ModuleDefinition::module);
  if (number == 0 || module == stream.modules.end())
    return names = {{"(no file)", "", 0, false, ""}};
  const std::string file = std::filesystem::path(module->path).filename();
  for (const Symbol& s : cache_->Around(*module, address & kFrameOffsetMask))
    names.push_back({Demangle(s.linkage_name), s.file, s.line, true, file});
  if (names.empty()) names.push_back({"(" + file + ")", "", 0, false, file});
  return names;
}

}  // namespace stipple
