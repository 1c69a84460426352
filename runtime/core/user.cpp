// SPDX-License-Identifier: MIT
// user.h: regions, marks, counters, messages between threads, the host.
#include "stipple/user.h"

#include "runtime/core/clock.h"
#include "runtime/core/process.h"
#include "runtime/core/recorder.h"
#include "runtime/core/region.h"

namespace stipple {
namespace {

/// The id that `find` gives a text; 0 when nothing is recorded.
template <class Find>
std::uint32_t NewId(Find find) {
  const SignalBlock signals_blocked;
  Process* process = BeginProcess();
  if (process == nullptr) return 0;
  Holding holding(process->lock);
  return find(*process);
}

/// The id in a handle, given at its first use by `define`; 0 when nothing is recorded. A handle
/// without a name was made at run time, when nothing could be recorded.
template <class Handle, class Define>
std::uint32_t IdOf(Handle* handle, Define define) {
  std::atomic_ref<std::uint32_t> id(handle->id);
  const std::uint32_t known = id.load(std::memory_order_relaxed);
  if (known != 0 || handle->name == nullptr) return known;
  const std::uint32_t given = define();
  if (given != 0) id.store(given, std::memory_order_relaxed);
  return given;
}

std::uint32_t NameOf(stipple_name* name) {
  return IdOf(name, [name] { return stipple_define_name(name->name, name->unit); });
}

std::uint32_t ChannelOf(stipple_channel* channel) {
  return IdOf(channel, [channel] { return stipple_define_channel(channel->name); });
}

template <class Record>
void Append(const Record& record) {
  stipple_append(&record, static_cast<std::uint8_t>(Record::kKind), sizeof record);
}

}  // namespace
}  // namespace stipple

extern "C" {

uint32_t stipple_define_name(const char* name, const char* unit) {
  return stipple::NewId(
      [=](stipple::Process& process) { return stipple::NameId(process, name, unit); });
}

uint32_t stipple_define_channel(const char* name) {
  return stipple::NewId(
      [=](stipple::Process& process) { return stipple::ChannelId(process, name); });
}

void stipple_record_begin(struct stipple_region* region) {
  const std::uint32_t id = stipple::IdOf(region, [region] {
    return stipple_define_region(region->name, region->file, region->line,
                                 static_cast<std::uint32_t>(stipple::RegionKind::kUser));
  });
  if (id != 0) stipple_enter(id);
}

/// A region without an id was never begun.
void stipple_record_end(struct stipple_region* region) {
  const std::uint32_t id =
      std::atomic_ref<std::uint32_t>(region->id).load(std::memory_order_relaxed);
  if (id != 0) stipple_leave(id);
}

void stipple_record_mark(struct stipple_name* name) {
  stipple::Mark record{};
  record.name = stipple::NameOf(name);
  if (record.name == 0) return;
  record.ticks = stipple::ReadTicks();
  stipple::Append(record);
}

void stipple_record_counter(struct stipple_name* name, double value) {
  stipple::Counter record{};
  record.name = stipple::NameOf(name);
  if (record.name == 0) return;
  record.value = value;
  record.ticks = stipple::ReadTicks();
  stipple::Append(record);
}

void stipple_record_send(struct stipple_channel* channel, uint64_t key, uint64_t bytes) {
  stipple::ThreadSend record{};
  record.channel = stipple::ChannelOf(channel);
  if (record.channel == 0) return;
  record.bytes = bytes;
  record.key = key;
  record.ticks = stipple::ReadTicks();
  stipple::Append(record);
}

void stipple_record_receive(struct stipple_channel* channel, uint64_t key, uint64_t bytes,
                            uint64_t waiting_since) {
  stipple::ThreadReceive record{};
  // First, since the message is here; and not before what took it has been executed, or a receive
  // could be told earlier than its send.
  __builtin_ia32_lfence();
  record.ticks = stipple::ReadTicks();
  record.channel = stipple::ChannelOf(channel);
  if (record.channel == 0) return;
  record.bytes = bytes;
  record.key = key;
  record.waiting_since = waiting_since;
  stipple::Append(record);
}

void stipple_record_host(void) {
  const stipple::DefineHost record{};
  stipple_define(&record, static_cast<uint8_t>(stipple::DefineHost::kKind), sizeof record, nullptr,
                 0);
}
}
