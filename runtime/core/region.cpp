// SPDX-License-Identifier: MIT
// One table for regions and one for names of marks. Entries stand in blocks that never move; an
// open hash table over them doubles. An entry is complete before the count or the hash table shows
// it, so a fork by another thread finds every table sound.
#include "runtime/core/region.h"

#include "runtime/core/address.h"
#include "runtime/core/arena.h"
#include "runtime/core/filter.h"
#include "runtime/core/line.h"
#include "runtime/core/recorder.h"
#include "runtime/core/settings.h"
#include "runtime/core/stream.h"
#include "runtime/core/switch.h"
#include "stipple/filter.h"

namespace stipple {
namespace {

constinit Arena arena;

/// What a number stands for. Regions: linkage name and source file; names: name and unit.
struct Entry {
  std::uint64_t hash;
  const char* name;
  const char* detail;
  std::uint32_t name_bytes;
  std::uint32_t detail_bytes;
  std::uint32_t line;
  RegionKind kind;
  std::uint64_t offset;  // in `module`: a function known by its address
  std::uint32_t module;  // 0: one that brought its name
  bool off;              // switched off by itself
  bool has_slots;
  RegionModeKind mode;
};

std::uint64_t HashOf(const Entry& entry) {
  std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a
  const auto add = [&hash](const char* text, std::uint32_t bytes) {
    for (std::uint32_t i = 0; i < bytes; ++i)
      hash = (hash ^ static_cast<unsigned char>(text[i])) * 0x100000001b3u;
    hash = (hash ^ 0xff) * 0x100000001b3u;
  };
  add(entry.name, entry.name_bytes);
  add(entry.detail, entry.detail_bytes);
  hash = (hash ^ entry.line ^ std::uint64_t{entry.module} << 32) * 0x100000001b3u;
  return hash ^ hash >> 32;
}

bool SameText(const char* a, const char* b, std::uint32_t bytes) {
  for (std::uint32_t i = 0; i < bytes; ++i)
    if (a[i] != b[i]) return false;
  return true;
}

bool Same(const Entry& a, const Entry& b) {
  return a.hash == b.hash && a.line == b.line && a.module == b.module && a.offset == b.offset &&
         a.name_bytes == b.name_bytes && a.detail_bytes == b.detail_bytes &&
         SameText(a.name, b.name, a.name_bytes) && SameText(a.detail, b.detail, a.detail_bytes);
}

/// Numbers entries from 1 on.
template <std::uint32_t kMost>
class Table {
 public:
  std::uint32_t count() const { return count_; }
  Entry& operator[](std::uint32_t id) { return blocks_[id / kBlock][id % kBlock]; }

  /// The id of an equal entry, or 0.
  std::uint32_t Find(const Entry& entry) {
    if (index_ == nullptr) return 0;
    const std::uint32_t* ids = index_->ids;
    for (std::uint64_t i = entry.hash;; ++i) {
      const std::uint32_t id = ids[i & index_->mask];
      if (id == 0) return 0;
      if (Same((*this)[id], entry)) return id;
    }
  }

  /// Adds an entry that is not there, its texts copied; 0 when full or without memory.
  std::uint32_t Add(Entry entry) {
    if (count_ >= kMost || !MakeRoom()) return 0;
    entry.name = arena.Copy(entry.name, entry.name_bytes);
    entry.detail = arena.Copy(entry.detail, entry.detail_bytes);
    if (entry.name == nullptr || entry.detail == nullptr) return 0;
    const std::uint32_t id = count_ + 1;
    (*this)[id] = entry;
    std::atomic_signal_fence(std::memory_order_seq_cst);
    count_ = id;
    std::atomic_signal_fence(std::memory_order_seq_cst);
    Insert(*index_, id);
    return id;
  }

 private:
  static constexpr std::uint32_t kBlock = 4096;
  struct Index {
    std::uint64_t mask;
    std::uint32_t ids[2];  // as many as the mask says
  };

  void Insert(Index& index, std::uint32_t id) {
    std::uint32_t* ids = index.ids;
    std::uint64_t i = (*this)[id].hash;
    while (ids[i & index.mask] != 0) ++i;
    ids[i & index.mask] = id;
  }

  bool MakeRoom() {
    const std::uint32_t id = count_ + 1;
    if (blocks_[id / kBlock] == nullptr)
      blocks_[id / kBlock] = static_cast<Entry*>(MapMemory(kBlock * sizeof(Entry)));
    if (blocks_[id / kBlock] == nullptr) return false;
    if (index_ != nullptr && id <= index_->mask / 2) return true;
    const std::uint64_t slots = index_ == nullptr ? 1024 : 2 * (index_->mask + 1);
    auto* grown = static_cast<Index*>(MapMemory(sizeof(Index) + slots * sizeof(std::uint32_t)));
    if (grown == nullptr) return false;
    grown->mask = slots - 1;
    // A photograph of a fork may have the last entry counted but not yet in the index.
    for (std::uint32_t old = 1; old <= count_; ++old) Insert(*grown, old);
    std::atomic_signal_fence(std::memory_order_seq_cst);
    index_ = grown;
    return true;
  }

  std::uint32_t count_ = 0;
  Index* index_ = nullptr;
  Entry* blocks_[kMost / kBlock + 1] = {};
};

constinit Table<kMaxRegion> regions;
constinit Table<65535> names;

/// In place of a region: the function is filtered.
constexpr std::uint32_t kFiltered = ~std::uint32_t{0};

/// An object with descriptors, and the region of each (0, kFiltered: never recorded).
struct Object {
  stipple_dso* dso;
  std::uint32_t* regions;
};

/// In any order.
struct ObjectList {
  Object* objects;
  std::uint32_t count;
  std::uint32_t room;
};
constinit ObjectList list{};

std::size_t DescriptorCount(const stipple_dso& object) {
  return static_cast<std::size_t>(object.end - object.begin);
}

/// Room for the regions of an object's functions; null without memory. Mapped, so that it can be
/// given back: objects may be loaded and unloaded without end.
std::uint32_t* MapRegions(const stipple_dso& dso) {
  return static_cast<std::uint32_t*>(MapMemory(DescriptorCount(dso) * sizeof(std::uint32_t)));
}

void UnmapRegions(const Object& object) {
  Syscall(SYS_munmap, Argument(object.regions),
          static_cast<long>(DescriptorCount(*object.dso) * sizeof(std::uint32_t)));
}

bool AddObject(const Object& object) {
  if (list.count == list.room) {
    const std::uint32_t room = list.room == 0 ? 64 : 2 * list.room;
    auto* objects = static_cast<Object*>(arena.Take(room * sizeof(Object)));
    if (objects == nullptr) return false;
    for (std::uint32_t i = 0; i < list.count; ++i) objects[i] = list.objects[i];
    std::atomic_signal_fence(std::memory_order_seq_cst);
    list.objects = objects;
    list.room = room;
  }
  list.objects[list.count] = object;
  std::atomic_signal_fence(std::memory_order_seq_cst);
  ++list.count;
  return true;
}

void RemoveObject(std::uint32_t index) {
  const Object gone = list.objects[index];
  list.objects[index] = list.objects[list.count - 1];
  std::atomic_signal_fence(std::memory_order_seq_cst);
  --list.count;
  UnmapRegions(gone);
}

/// A slot that stays as it is is not written: its page may still be the file's own.
void SetSlot(stipple_descriptor& descriptor, std::uint32_t token) {
  std::atomic_ref<std::uint32_t> slot(descriptor.id);
  if (slot.load(std::memory_order_relaxed) != token) slot.store(token, std::memory_order_release);
}

void Silence(stipple_dso& object) {
  for (stipple_descriptor* d = object.begin; d < object.end; ++d) SetSlot(*d, 0);
}

bool DefineRegionRecord(Process& process, std::uint32_t id) {
  const Entry& entry = regions[id];
  DefineRegion record{};
  record.region = id;
  record.region_kind = entry.kind;
  record.line = entry.line;
  record.name_bytes = entry.name_bytes;
  record.file_bytes = entry.detail_bytes;
  if (!Define(process, &record, DefineRegion::kKind, sizeof record, entry.name, entry.name_bytes,
              entry.detail, entry.detail_bytes))
    return false;
  if (entry.module == 0) return true;
  DefineCode code{};
  code.region = id;
  code.module = entry.module;
  code.offset = entry.offset;
  return Define(process, &code, DefineCode::kKind, sizeof code);
}

bool DefineNameRecord(Process& process, std::uint32_t id) {
  const Entry& entry = names[id];
  DefineName record{};
  record.name = id;
  record.name_bytes = entry.name_bytes;
  record.unit_bytes = entry.detail_bytes;
  return Define(process, &record, DefineName::kKind, sizeof record, entry.name, entry.name_bytes,
                entry.detail, entry.detail_bytes);
}

/// Says in the archive, once, that some functions have no id.
void NoteNoRegionsLeft(Process& process) {
  if (process.said_regions != 0) return;
  process.said_regions = 1;
  static constexpr char kWhat[] = "region ids";
  Availability record{};
  record.what_bytes = sizeof kWhat - 1;
  Define(process, &record, Availability::kKind, sizeof record, kWhat, sizeof kWhat - 1);
}

Entry MakeEntry(const char* name, const char* detail, std::uint32_t line, RegionKind kind) {
  Entry entry{};
  entry.name = name != nullptr ? name : "";
  entry.detail = detail != nullptr ? detail : "";
  // A record of two texts must stay far below the largest; nobody reads a longer name.
  constexpr std::size_t kMostBytes = 1024 * 1024;
  const auto bytes = [](const char* text) {
    const std::size_t length = TextBytes(text);
    return static_cast<std::uint32_t>(length < kMostBytes ? length : kMostBytes);
  };
  entry.name_bytes = bytes(entry.name);
  entry.detail_bytes = bytes(entry.detail);
  entry.line = line;
  entry.kind = kind;
  entry.hash = HashOf(entry);
  return entry;
}

std::uint32_t RegionFor(Process& process, const Entry& entry) {
  std::uint32_t id = regions.Find(entry);
  if (id != 0) return id;
  id = regions.Add(entry);
  if (id == 0) NoteNoRegionsLeft(process);
  return id != 0 && DefineRegionRecord(process, id) ? id : 0;
}

const char* TextAt(const std::int64_t& field) {
  return field == 0 ? nullptr : reinterpret_cast<const char*>(&field) + field;
}

/// Marks the functions that the filter excludes. The lock is not held.
void FilterObject(const Object& object) {
  if (!HasFilter()) return;
  for (std::size_t i = 0; i < DescriptorCount(*object.dso); ++i) {
    const stipple_descriptor& d = object.dso->begin[i];
    const char* name = TextAt(d.name);
    if (name != nullptr && IsFiltered(name, TextAt(d.file))) object.regions[i] = kFiltered;
  }
}

/// Says in the archive what the filter did to `functions` of an object, if there is one.
void DefineFiltered(Process& process, std::uint32_t functions, std::uint32_t filtered) {
  const char* path = FilterPath();
  if (path == nullptr) return;
  Filtered record{};
  record.functions = functions;
  record.filtered = filtered;
  record.path_bytes = static_cast<std::uint32_t>(TextBytes(path));
  Define(process, &record, Filtered::kKind, sizeof record, path, record.path_bytes);
}

/// Gives every function of a new object that is not filtered its region.
void DefineObject(Process& process, const Object& object) {
  const std::size_t count = DescriptorCount(*object.dso);
  std::uint32_t filtered = 0;
  for (std::size_t i = 0; i < count; ++i) filtered += object.regions[i] == kFiltered ? 1 : 0;
  DefineFiltered(process, static_cast<std::uint32_t>(count), filtered);
  for (std::size_t i = 0; i < count; ++i) {
    stipple_descriptor& d = object.dso->begin[i];
    const char* name = TextAt(d.name);
    if (name == nullptr || object.regions[i] == kFiltered) continue;
    const std::uint32_t region =
        RegionFor(process, MakeEntry(name, TextAt(d.file), d.line, RegionKind::kFunction));
    if (process.state.load(std::memory_order_relaxed) == State::kStopped) return;
    object.regions[i] = region;
    if (region != 0) regions[region].has_slots = true;
    SetSlot(d, TokenOf(region));
  }
}

}  // namespace

void DefineAll(Process& process) {
  DefineFiltered(process, 0, 0);  // whether or not an object comes
  DefineModules(process);
  for (std::uint32_t id = 1; id <= regions.count(); ++id)
    if (!DefineRegionRecord(process, id)) return;
  for (std::uint32_t id = 1; id <= names.count(); ++id)
    if (!DefineNameRecord(process, id)) return;
}

void SilenceAll() {
  for (std::uint32_t i = 0; i < list.count; ++i) Silence(*list.objects[i].dso);
  SilenceAddresses();
}

RegionModeKind ModeOf(std::uint32_t region) { return regions[region].mode; }
void SetMode(std::uint32_t region, RegionModeKind mode) { regions[region].mode = mode; }
bool HasSlots(std::uint32_t region) { return regions[region].has_slots; }

std::uint32_t TokenOf(std::uint32_t region) {
  constexpr std::uint32_t kModes[] = {0, STIPPLE_NO_CLOCK, STIPPLE_COUNT_ONLY};
  const bool has_region = region != 0 && region != kFiltered;
  if (!has_region || !IsSwitchedOn() || regions[region].off) return 0;
  return region | kModes[static_cast<std::uint32_t>(regions[region].mode)];
}

void UpdateAll() {
  for (std::uint32_t i = 0; i < list.count; ++i) {
    const Object& object = list.objects[i];
    for (std::size_t d = 0; d < DescriptorCount(*object.dso); ++d)
      SetSlot(object.dso->begin[d], TokenOf(object.regions[d]));
  }
  UpdateAddresses();
}

bool IsFunctionNamed(std::uint32_t region, std::string_view pattern) {
  const Entry& entry = regions[region];
  if (entry.kind != RegionKind::kFunction) return false;
  const ReadableName name(entry.name);
  return MatchesPattern(pattern, name.text());
}

void SwitchRegion(Process& process, std::uint32_t region, bool on) {
  if (regions[region].off != on) return;
  regions[region].off = !on;
  DefineSwitch(process, on, region);
}

void DefineRegionSwitches(Process& process) {
  for (std::uint32_t id = 1; id <= regions.count(); ++id)
    if (regions[id].off) DefineSwitch(process, false, id);
}

std::uint32_t CodeRegion(Process& process, const Module* module, std::uintptr_t address) {
  Line<256> name;
  Entry entry{};
  if (module == nullptr) {
    name.AddHex(address);
    entry = MakeEntry(name.text(), nullptr, 0, RegionKind::kFunction);
    return RegionFor(process, entry);
  }
  const char* file = module->path;
  for (const char* c = file; *c != '\0'; ++c)
    if (*c == '/') file = c + 1;
  name.Add(file).Add("+").AddHex(address - module->load_bias);
  entry = MakeEntry(name.text(), module->path, 0, RegionKind::kFunction);
  entry.module = module->number;
  entry.offset = address - module->load_bias;
  entry.hash = HashOf(entry);
  return RegionFor(process, entry);
}

std::uint32_t LastRegion() { return regions.count(); }

std::uint32_t NameId(Process& process, const char* name, const char* unit) {
  const Entry entry = MakeEntry(name, unit, 0, RegionKind::kUser);
  std::uint32_t id = names.Find(entry);
  if (id != 0) return id;
  id = names.Add(entry);
  return id != 0 && DefineNameRecord(process, id) ? id : 0;
}

}  // namespace stipple

extern "C" {

void stipple_register(struct stipple_dso* dso) {
  if (dso == nullptr || dso->abi != STIPPLE_ABI ||
      dso->descriptor_bytes != sizeof(stipple_descriptor) || dso->begin == dso->end)
    return;
  if (stipple::ReadSettings().archive == nullptr) return;
  const stipple::Object object = {dso, stipple::MapRegions(*dso)};
  if (object.regions == nullptr) return;
  stipple::FilterObject(object);
  const stipple::SignalBlock signals_blocked;
  stipple::Process* process = stipple::BeginProcess();
  if (process == nullptr) return stipple::UnmapRegions(object);
  stipple::Holding holding(process->lock);
  if (!stipple::AddObject(object)) return stipple::UnmapRegions(object);
  dso->tp_offset = stipple::ControlSlotOffset();
  dso->slow = stipple_slow;
  stipple::DefineObject(*process, object);
}

void stipple_unregister(struct stipple_dso* dso) {
  if (dso == nullptr || stipple::list.count == 0) return;
  const stipple::SignalBlock signals_blocked;
  stipple::Process* process = stipple::ThisProcess();
  if (process == nullptr) return;
  stipple::Holding holding(process->lock);
  for (std::uint32_t i = 0; i < stipple::list.count; ++i) {
    if (stipple::list.objects[i].dso != dso) continue;
    stipple::Silence(*dso);
    stipple::RemoveObject(i);
    return;
  }
}

uint32_t stipple_define_region(const char* name, const char* file, uint32_t line, uint32_t kind) {
  const stipple::SignalBlock signals_blocked;
  stipple::Process* process = stipple::BeginProcess();
  if (process == nullptr) return 0;
  stipple::Holding holding(process->lock);
  return stipple::RegionFor(
      *process, stipple::MakeEntry(name, file, line, static_cast<stipple::RegionKind>(kind)));
}
}
