// SPDX-License-Identifier: MIT
// A process that never records owns one pointer. The state below is mapped at the first
// registration, in pages that a forked child finds zeroed: the child is a new process that has not
// begun, and its first event begins its own stream.
#include "runtime/core/process.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/utsname.h>

#include "runtime/core/clock.h"
#include "runtime/core/hooks.h"
#include "runtime/core/observer.h"
#include "runtime/core/recorder.h"
#include "runtime/core/region.h"
#include "runtime/core/sample.h"
#include "runtime/core/settings.h"
#include "runtime/core/stream.h"
#include "runtime/core/switch.h"

namespace stipple {
namespace {

constinit std::atomic<Process*> this_process{nullptr};
constinit bool begun_before = false;  // in this program, by this process or one it was forked from

/// Reads a small file of /proc; returns the bytes read.
std::size_t ReadSmallFile(const char* path, char* to, std::size_t bytes) {
  const long descriptor = Syscall(SYS_open, Argument(path), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return 0;
  std::size_t length = 0;
  while (length < bytes) {
    const long got =
        Syscall(SYS_read, descriptor, Argument(to + length), static_cast<long>(bytes - length));
    if (got <= 0) break;
    length += static_cast<std::size_t>(got);
  }
  Syscall(SYS_close, descriptor);
  return length;
}

/// Copies at most `kBytes` - 1 bytes of a text.
template <std::size_t kBytes>
void CopyText(char (&to)[kBytes], const char* text) {
  for (std::size_t i = 0; i + 1 < kBytes && text[i] != '\0'; ++i) to[i] = text[i];
}

/// The executable's file name without its directories.
void ReadProgramName(char (&name)[256]) {
  // A simulator's own program would be the answer below.
  const char* simulated = kSimulated ? getenv("STIPPLE_PROGRAM") : nullptr;
  if (simulated != nullptr) return CopyText(name, simulated);
  char path[512];
  const long bytes =
      Syscall(SYS_readlink, Argument("/proc/self/exe"), Argument(path), sizeof path - 1);
  path[bytes > 0 ? bytes : 0] = '\0';
  const char* last = path;
  for (const char* c = path; *c != '\0'; ++c)
    if (*c == '/') last = c + 1;
  CopyText(name, last);
}

const char* HostName(const utsname& system) {
  for (const char* c = system.nodename; *c != '\0'; ++c)
    if (*c == '/') return "host";
  return system.nodename[0] != '\0' ? system.nodename : "host";
}

void WriteFileHeader(char* place, const Process& process, std::uint64_t realtime_ns,
                     const ClockPair& start, const utsname& system) {
  FileHeader& header = *reinterpret_cast<FileHeader*>(place);
  header.version = kFormatVersion;
  header.minimum_reader_version = kFormatVersion;
  header.pid = process.pid;
  header.parent_pid = static_cast<std::uint32_t>(Syscall(SYS_getppid));
  header.start_realtime_ns = realtime_ns;
  header.start_raw_ns = start.raw_ns;
  header.start_ticks = start.ticks;
  header.clock = kClockKind;
  header.forked = begun_before ? 1 : 0;
  header.tsc_hz = StatedTicksPerSecond();
  const std::size_t id_bytes =
      ReadSmallFile("/proc/sys/kernel/random/boot_id", header.boot_id, sizeof header.boot_id - 1);
  if (id_bytes > 0 && header.boot_id[id_bytes - 1] == '\n') header.boot_id[id_bytes - 1] = '\0';
  CopyText(header.host_name, HostName(system));
  ReadProgramName(header.program);
  CopyText(header.settings, ReadSettings().text);
  std::atomic_ref<std::uint64_t>(header.magic).store(kFileMagic, std::memory_order_release);
}

/// A simulator's command line without what is the simulator's: the program, which it is given first
/// ("smpimain PROGRAM SETTINGS -- ARGUMENTS"), and the arguments. Returns the bytes.
std::size_t WithoutSimulator(char* text, std::size_t bytes) {
  const std::size_t program = TextBytes(text) + 1;
  std::size_t arguments = program;
  while (arguments + 4 < bytes && (text[arguments] != '\0' || text[arguments + 1] != '-' ||
                                   text[arguments + 2] != '-' || text[arguments + 3] != '\0'))
    ++arguments;
  if (arguments + 4 >= bytes) return bytes;
  const std::size_t name_bytes = TextBytes(text + program) + 1;
  CopyBytes(text, text + program, name_bytes);
  CopyBytes(text + name_bytes, text + arguments + 4, bytes - arguments - 4);
  return name_bytes + bytes - arguments - 4;
}

void DefineCommandLine(Process& process) {
  constexpr std::size_t kMostBytes = 64 * 1024;
  char* text = static_cast<char*>(MapMemory(kMostBytes));
  if (text == nullptr) return;
  std::size_t bytes = ReadSmallFile("/proc/self/cmdline", text, kMostBytes);
  if (kSimulated) bytes = WithoutSimulator(text, bytes);
  if (bytes > 0 && text[bytes - 1] == '\0') --bytes;  // between arguments only
  CommandLine record{};
  record.text_bytes = static_cast<std::uint32_t>(bytes);
  Define(process, &record, CommandLine::kKind, sizeof record, text, bytes);
  Syscall(SYS_munmap, Argument(text), static_cast<long>(kMostBytes));
}

/// What an errno means, in the words of its manual page.
const char* ErrorText(int error) {
  struct Row {
    int error;
    const char* text;
  };
  static constexpr Row kRows[] = {{ENOSPC, "no space left on device"},
                                  {EDQUOT, "disk quota exceeded"},
                                  {EFBIG, "file size limit exceeded"},
                                  {EIO, "input/output error"},
                                  {EROFS, "read-only file system"},
                                  {EACCES, "permission denied"},
                                  {EPERM, "operation not permitted"},
                                  {ENOENT, "no such file or directory"},
                                  {ENOTDIR, "not a directory"},
                                  {ENOMEM, "out of memory"},
                                  {EMFILE, "too many open files"},
                                  {ENFILE, "too many open files in system"},
                                  {ESTALE, "the stream file was replaced"},
                                  {ENAMETOOLONG, "file name too long"}};
  for (const Row& row : kRows)
    if (row.error == error) return row.text;
  return nullptr;
}

template <std::size_t kBytes>
void AddError(Line<kBytes>& line, int error) {
  if (const char* text = ErrorText(error))
    line.Add(text);
  else
    line.Add("error ").Add(static_cast<std::uint64_t>(error));
}

template <std::size_t kBytes>
void AddProgram(Line<kBytes>& line) {
  char program[256] = {};
  ReadProgramName(program);
  line.Add("stipple: ").Add(program).Add(" (pid ").Add(GetPid()).Add("): ");
}

/// Says once that the process could not begin to record.
void SayNothingRecorded(Process& process, const char* archive) {
  Line<512> line;
  AddProgram(line);
  line.Add("nothing recorded, ");
  AddError(line, process.error);
  line.Add(": ").Add(archive).Add("\n");
  line.Print();
  process.said_line = 1;
}

/// Says once, at the end, that the recording stopped.
void SayStopped(Process& process) {
  if (process.said_line != 0) return;
  process.said_line = 1;
  Line<512> line;
  AddProgram(line);
  line.Add("recording stopped, ");
  AddError(line, process.error);
  line.Add("; events lost after ").AddSeconds(process.stop_ms).Add(" s: at least ");
  line.Add(process.lost.load(std::memory_order_relaxed)).Add("\n");
  line.Print();
}

/// Creates the file and writes what stands at its begin; 0 or an errno. The lock is held.
int BeginFile(Process& process, const char* archive) {
  utsname system{};
  Syscall(SYS_uname, Argument(&system));
  const std::uint64_t realtime_ns = ReadClockNs(CLOCK_REALTIME);
  const ClockPair start = ReadClockPair();
  process.begin_raw_ns = start.raw_ns;
  process.begin_ticks = start.ticks;
  int error = CreateFile(process.file, archive, HostName(system), process.pid, realtime_ns);
  if (error != 0) return error;
  char* header = TakeBytes(process.file, kGranuleBytes, &error);
  if (header == nullptr) {
    // A stream without a header would only be reported as damaged.
    Syscall(SYS_unlink, Argument(process.file.path.text()));
    Syscall(SYS_close, process.file.descriptor);
    return error;
  }
  WriteFileHeader(header, process, realtime_ns, start, system);
  process.header = reinterpret_cast<FileHeader*>(header);
  if (ReadSettings().max_bytes != 0) BeginRing(process, ReadSettings().max_bytes);
  return 0;
}

}  // namespace

constinit Hooks hooks{};

Process* ThisProcess() {
  Process* process = this_process.load(std::memory_order_acquire);
  if (process != nullptr) return process;
  constexpr std::size_t kBytes = (sizeof(Process) + 4095) & ~std::size_t{4095};
  auto* fresh = static_cast<Process*>(MapWipedMemory(kBytes));
  if (fresh == nullptr) return nullptr;
  if (this_process.compare_exchange_strong(process, fresh, std::memory_order_acq_rel)) return fresh;
  Syscall(SYS_munmap, Argument(fresh), static_cast<long>(kBytes));
  return process;
}

bool HasStopped() {
  const Process* process = this_process.load(std::memory_order_acquire);
  return process != nullptr && process->state.load(std::memory_order_acquire) == State::kStopped;
}

Process* BeginProcess() {
  Process* process = this_process.load(std::memory_order_acquire);
  if (process != nullptr) {
    const State state = process->state.load(std::memory_order_acquire);
    if (state != State::kNew) return state == State::kRecording ? process : nullptr;
  }
  const Settings& settings = ReadSettings();
  if (settings.archive == nullptr) return nullptr;
  process = ThisProcess();
  if (process == nullptr) return nullptr;
  Holding holding(process->lock);
  if (process->state.load(std::memory_order_relaxed) == State::kNew) {
    process->pid = GetPid();
    process->first_tid = GetTid();
    const int error = BeginFile(*process, settings.archive);
    if (error != 0) {
      process->error = error;
      process->state.store(State::kStopped, std::memory_order_release);
      SilenceAll();  // what the parent of a forked child had given ids
      SayNothingRecorded(*process, settings.archive);
      return nullptr;
    }
    if (!begun_before && settings.paused) BeginPaused();
    begun_before = true;
    PrepareThreads();
    DefineCommandLine(*process);
    DefineAll(*process);
    DefineSwitches(*process);
    if (hooks.definitions != nullptr) hooks.definitions(*process);
    if (hooks.process_begun != nullptr) hooks.process_begun();
    if (process->state.load(std::memory_order_relaxed) == State::kNew)
      process->state.store(State::kRecording, std::memory_order_release);
  }
  return process->state.load(std::memory_order_relaxed) == State::kRecording ? process : nullptr;
}

void StopProcess(Process& process, int error) {
  if (process.state.load(std::memory_order_relaxed) == State::kStopped) return;
  process.state.store(State::kStopped, std::memory_order_release);
  process.error = error;
  process.stop_ms = (ReadClockNs(CLOCK_MONOTONIC_RAW) - process.begin_raw_ns) / 1000000;
  SilenceAll();
  Loss* place = process.definitions.loss;
  if (place == nullptr) return;
  constexpr std::uint64_t kWords = sizeof(Loss) / 8;
  std::atomic_ref<EventWord> header(place->header);
  header.store(MakeHeader(Loss::kKind, kWords, false), std::memory_order_release);
  place->from_ticks = ReadTicks();
  place->events = process.lost.load(std::memory_order_relaxed);
  place->error = error;
  header.store(MakeHeader(Loss::kKind, kWords, true), std::memory_order_release);
}

void NoteFeature(Feature feature) {
  Process* process = this_process.load(std::memory_order_acquire);
  if (process == nullptr || process->header == nullptr) return;
  const auto bit = static_cast<std::uint64_t>(feature);
  std::atomic_ref<std::uint64_t> features(process->header->features);
  if ((features.load(std::memory_order_relaxed) & bit) == 0) features.fetch_or(bit);
}

void NoteEnd(Ending how, int status) {
  Process* process = this_process.load(std::memory_order_acquire);
  if (process == nullptr) return;
  const SignalBlock signals_blocked;
  // A child of vfork runs in its parent's memory: it is not the parent that ends.
  if (process->pid != GetPid()) return;
  if (process->state.load(std::memory_order_acquire) == State::kRecording)
    Tell(&stipple_observer::process_ends);
  if (hooks.process_ending != nullptr) hooks.process_ending(*process);
  Holding holding(process->lock);
  WriteVisitCounts(*process);
  if (ProcessEnd* place = process->definitions.process_end) {
    constexpr std::uint64_t kWords = sizeof(ProcessEnd) / 8;
    std::atomic_ref<EventWord> header(place->header);
    header.store(MakeHeader(ProcessEnd::kKind, kWords, false), std::memory_order_release);
    const ClockPair now = ReadClockPair();
    place->ticks = now.ticks;
    place->raw_ns = now.raw_ns;
    place->lost = process->lost.load(std::memory_order_relaxed);
    place->how = static_cast<std::uint32_t>(how);
    place->status = status;
    header.store(MakeHeader(ProcessEnd::kKind, kWords, true), std::memory_order_release);
    TrimFile(process->file);
  }
  if (process->state.load(std::memory_order_relaxed) == State::kStopped) SayStopped(*process);
}

void RetractEnd() {
  Process* process = this_process.load(std::memory_order_acquire);
  if (process == nullptr) return;
  const SignalBlock signals_blocked;
  if (process->pid != GetPid() || process->definitions.process_end == nullptr) return;
  std::atomic_ref<EventWord>(process->definitions.process_end->header)
      .store(0, std::memory_order_release);
  process->file.closing = false;
}

}  // namespace stipple

extern "C" {

bool stipple_begin() {
  {
    const stipple::SignalBlock signals_blocked;
    if (stipple::BeginProcess() == nullptr) return false;
  }
  if (stipple::hooks.recording != nullptr) stipple::hooks.recording();
  return true;
}

bool stipple_recording() {
  const stipple::Process* process = stipple::this_process.load(std::memory_order_acquire);
  return process != nullptr &&
         process->state.load(std::memory_order_acquire) == stipple::State::kRecording &&
         stipple::IsSwitchedOn();
}
}
