// SPDX-License-Identifier: MIT
// The kernel's list of mappings says which file lies where, by its absolute path; the file's
// headers, as mapped, say the rest. All memory is read through /proc/self/mem: another thread may
// unmap it meanwhile, and that must be an error and not a crash.
#include "runtime/core/module.h"

#include <elf.h>
#include <fcntl.h>

#include <new>

#include "runtime/core/arena.h"

namespace stipple {
namespace {

constinit Arena arena;
constinit Module* newest = nullptr;
constinit std::uint32_t last_number = 0;

constexpr std::uint64_t kPageMask = 4095;
constexpr std::uint32_t kMostBuildIdBytes = 64;

/// A file that is closed at the end.
class OpenFile {
 public:
  explicit OpenFile(const char* path)
      : descriptor_(Syscall(SYS_open, Argument(path), O_RDONLY | O_CLOEXEC)) {}
  ~OpenFile() {
    if (descriptor_ >= 0) Syscall(SYS_close, descriptor_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  long Read(char* to, std::size_t bytes) const {
    return Syscall(SYS_read, descriptor_, Argument(to), static_cast<long>(bytes));
  }
  /// Whether all `bytes` at `offset` could be read.
  bool ReadAt(std::uint64_t offset, void* to, std::size_t bytes) const {
    return Syscall(SYS_pread64, descriptor_, Argument(to), static_cast<long>(bytes),
                   static_cast<long>(offset)) == static_cast<long>(bytes);
  }

 private:
  long descriptor_;
};

constexpr char kOwnMemory[] = "/proc/self/mem";

/// A line of /proc/self/maps.
struct Mapping {
  std::uint64_t begin, end, offset, device, inode;
  const char* path;
  std::size_t path_bytes;
};

std::uint64_t TakeNumber(const char*& at, const char* end, unsigned base) {
  std::uint64_t number = 0;
  for (; at < end; ++at) {
    const char c = *at;
    const unsigned digit = c >= '0' && c <= '9'   ? static_cast<unsigned>(c - '0')
                           : c >= 'a' && c <= 'f' ? static_cast<unsigned>(c - 'a') + 10
                                                  : base;
    if (digit >= base) break;
    number = number * base + digit;
  }
  return number;
}

/// "begin-end perm offset major:minor inode   path"
Mapping ParseMapping(const char* at, const char* end) {
  Mapping m{};
  m.begin = TakeNumber(at, end, 16);
  m.end = TakeNumber(++at, end, 16);
  at += 6;
  m.offset = TakeNumber(at, end, 16);
  const std::uint64_t major = TakeNumber(++at, end, 16);
  m.device = major << 32 | TakeNumber(++at, end, 16);
  m.inode = TakeNumber(++at, end, 10);
  while (at < end && *at == ' ') ++at;
  m.path = at;
  m.path_bytes = at < end ? static_cast<std::size_t>(end - at) : 0;
  return m;
}

/// A file as mapped, from its first byte on: neighbours of one file are one mapping.
struct WholeFile {
  Mapping mapping;
  char path[4200];
};

/// The lines of /proc/self/maps, one after the other.
struct LineReader {
  OpenFile file{"/proc/self/maps"};
  std::size_t begin = 0;
  std::size_t end = 0;
  char text[16 * 1024];

  /// False: no line left. The text is valid until the next call.
  bool Next(Mapping& mapping) {
    for (std::size_t at = begin;; ++at) {
      if (at == end && !Refill(at)) return false;
      if (text[at] != '\n') continue;
      mapping = ParseMapping(text + begin, text + at);
      begin = at + 1;
      return true;
    }
  }

 private:
  bool Refill(std::size_t& at) {
    CopyBytes(text, text + begin, end - begin);
    at = end -= begin;
    begin = 0;
    const long got = file.Read(text + end, sizeof text - end);
    if (got <= 0) return false;
    end += static_cast<std::size_t>(got);
    return true;
  }
};

struct Search {
  LineReader lines;
  WholeFile found;
};

bool FindMapping(Search& search, std::uintptr_t address) {
  Mapping& whole = search.found.mapping;
  bool found = false;
  for (Mapping m{}; search.lines.Next(m);) {
    const bool goes_on = m.offset != 0 && m.inode != 0 && m.inode == whole.inode &&
                         m.device == whole.device && m.begin == whole.end;
    if (goes_on) {
      whole.end = m.end;
    } else {
      if (found) break;
      whole = m;
      if (whole.path_bytes > sizeof search.found.path) whole.path_bytes = sizeof search.found.path;
      CopyBytes(search.found.path, m.path, whole.path_bytes);
      whole.path = search.found.path;
    }
    found = found || (address >= m.begin && address < m.end);
  }
  return found;
}

/// Calls `use` with the file that holds `address`, if there is one, else with null.
template <class Use>
auto WithMapping(std::uintptr_t address, Use use) {
  void* memory = MapMemory(sizeof(Search));  // too large for a signal's stack
  if (memory == nullptr) return use(static_cast<const Mapping*>(nullptr));
  auto* search = new (memory) Search;
  const bool found = FindMapping(*search, address) && search->found.mapping.inode != 0;
  auto result = use(found ? &search->found.mapping : nullptr);
  search->~Search();
  Syscall(SYS_munmap, Argument(memory), static_cast<long>(sizeof(Search)));
  return result;
}

/// Looks for the build-id among the notes at `from`.
void ReadNotes(const OpenFile& memory, std::uint64_t from, std::uint64_t bytes, Module& module) {
  for (std::uint64_t at = from; at + sizeof(Elf64_Nhdr) < from + bytes;) {
    Elf64_Nhdr note{};
    char name[4] = {};
    if (!memory.ReadAt(at, &note, sizeof note)) return;
    const std::uint64_t text = at + sizeof note + ((std::uint64_t{note.n_namesz} + 3) & ~3ull);
    if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == 4 &&
        memory.ReadAt(at + sizeof note, name, sizeof name) && name[0] == 'G' && name[1] == 'N') {
      module.build_id_at = text;
      module.build_id_bytes = note.n_descsz < kMostBuildIdBytes ? note.n_descsz : kMostBuildIdBytes;
      return;
    }
    at = text + ((std::uint64_t{note.n_descsz} + 3) & ~3ull);
  }
}

/// Fills in what the file's headers say; false if it is no ELF file.
bool ReadHeaders(Module& module) {
  const OpenFile memory(kOwnMemory);
  Elf64_Ehdr file{};
  if (!memory.ReadAt(module.begin, &file, sizeof file) || file.e_ident[0] != ELFMAG0 ||
      file.e_ident[1] != 'E' || file.e_ident[2] != 'L' || file.e_ident[3] != 'F')
    return false;
  bool have_bias = false;
  for (unsigned pass = 0; pass < 2; ++pass) {  // the bias first: notes need it
    for (unsigned i = 0; i < file.e_phnum; ++i) {
      Elf64_Phdr part{};
      if (!memory.ReadAt(module.begin + file.e_phoff + i * sizeof part, &part, sizeof part)) break;
      if (pass == 0 && part.p_type == PT_LOAD && !have_bias) {
        have_bias = true;
        module.load_bias = module.begin - ((part.p_vaddr - part.p_offset) & ~kPageMask);
      }
      if (pass == 1 && part.p_type == PT_NOTE && module.build_id_at == 0)
        ReadNotes(memory, module.load_bias + part.p_vaddr, part.p_memsz, module);
    }
  }
  return have_bias;
}

bool SameBytes(const char* a, const char* b, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i)
    if (a[i] != b[i]) return false;
  return true;
}

bool SameFile(const Module& a, const Module& b) {
  return a.path_bytes == b.path_bytes && a.build_id_bytes == b.build_id_bytes &&
         SameBytes(a.path, b.path, a.path_bytes) &&
         SameBytes(a.build_id, b.build_id, a.build_id_bytes) &&
         (a.build_id_bytes != 0 || (a.inode == b.inode && a.device == b.device));
}

void DefineThisModule(Process& process, const Module& module) {
  DefineModule record{};
  record.module = module.number;
  record.path_bytes = module.path_bytes;
  record.build_id_bytes = module.build_id_bytes;
  Define(process, &record, DefineModule::kKind, sizeof record, module.path, module.path_bytes,
         module.build_id, module.build_id_bytes);
}

/// Numbers a module and keeps it; null without memory.
Module* Keep(Process& process, Module module, const Mapping& mapping) {
  char build_id[kMostBuildIdBytes];
  if (!OpenFile(kOwnMemory).ReadAt(module.build_id_at, build_id, module.build_id_bytes))
    module.build_id_bytes = 0;
  module.path = mapping.path;
  module.path_bytes = static_cast<std::uint32_t>(mapping.path_bytes);
  module.build_id = build_id;
  for (Module* other = newest; other != nullptr && module.number == 0; other = other->next) {
    if (!SameFile(*other, module)) continue;
    module.number = other->number;
    if (other->mapped) break;  // twice, in two name spaces of the loader
    const Module before = *other;  // loaded again
    module.path = before.path;
    module.build_id = before.build_id;
    module.next = before.next;
    *other = module;
    return other;
  }
  const bool is_new = module.number == 0;
  if (is_new) module.number = last_number + 1;
  module.path = arena.Copy(module.path, module.path_bytes);
  module.build_id = arena.Copy(module.build_id, module.build_id_bytes);
  auto* kept = static_cast<Module*>(arena.Take(sizeof(Module)));
  if (module.path == nullptr || module.build_id == nullptr || kept == nullptr) return nullptr;
  module.next = newest;
  *kept = module;
  std::atomic_signal_fence(std::memory_order_seq_cst);
  newest = kept;
  if (is_new) {
    last_number = module.number;
    DefineThisModule(process, module);
  }
  return kept;
}

}  // namespace

Module* Modules() { return newest; }

Module* KnownModuleAt(std::uintptr_t address) {
  for (Module* m = newest; m != nullptr; m = m->next)
    if (m->mapped && address >= m->begin && address < m->end) return m;
  return nullptr;
}

bool StillMapped(Module& module) {
  if (!module.mapped) return false;
  char build_id[kMostBuildIdBytes];
  if (module.build_id_bytes != 0)
    module.mapped =
        OpenFile(kOwnMemory).ReadAt(module.build_id_at, build_id, module.build_id_bytes) &&
        SameBytes(build_id, module.build_id, module.build_id_bytes);
  else
    module.mapped = WithMapping(module.begin, [&module](const Mapping* mapping) {
      return mapping != nullptr && mapping->begin == module.begin &&
             mapping->inode == module.inode && mapping->device == module.device;
    });
  return module.mapped;
}

Module* ModuleAt(Process& process, std::uintptr_t address) {
  if (Module* known = KnownModuleAt(address)) return known;
  return WithMapping(address, [&process](const Mapping* mapping) -> Module* {
    if (mapping == nullptr || mapping->offset != 0) return nullptr;
    Module module{};
    module.mapped = true;
    module.begin = mapping->begin;
    module.end = mapping->end;
    module.device = mapping->device;
    module.inode = mapping->inode;
    return ReadHeaders(module) ? Keep(process, module, *mapping) : nullptr;
  });
}

void DefineModules(Process& process) {
  // By number, the oldest first, once each.
  for (std::uint32_t number = 1; number <= last_number; ++number)
    for (const Module* m = newest; m != nullptr; m = m->next)
      if (m->number == number) {
        DefineThisModule(process, *m);
        break;
      }
}

}  // namespace stipple
