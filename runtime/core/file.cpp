// SPDX-License-Identifier: MIT
// Every byte is allocated on disk before it is mapped: writing to a hole of a full disk would kill
// the program by SIGBUS, while a failed allocation is a return value. Mappings stay until the
// process ends: an event may have reserved its slot just before a signal handler filled the rest of
// the chunk and several more.
#include "runtime/core/file.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "stipple/format.h"

namespace stipple {
namespace {

constexpr std::uint64_t kFirstExtentBytes = 256 * 1024;
constexpr std::uint64_t kLargestExtentBytes = 16 * 1024 * 1024;
// A long stream must not push the program's own files out of memory, and pages that are used again
// cost a tenth of fresh ones in a virtual machine: what is older than this is written out and
// dropped from the page cache, batch by batch. That costs 1.3 ns per event, so a short stream is
// left to the kernel.
constexpr std::uint64_t kBatchBytes = 8 * 1024 * 1024;
constexpr std::uint64_t kDirtyBatches = 16;
constexpr std::uint64_t kCachedBatches = 32;
constexpr int kHighDescriptor = 700;  // out of the way of programs that count on low numbers

bool IsOurs(const StreamFile& file, int descriptor) {
  struct stat status {};
  return Syscall(SYS_fstat, descriptor, Argument(&status)) == 0 && status.st_dev == file.device &&
         status.st_ino == file.inode;
}

int MoveUp(int descriptor) {
  const long high = Syscall(SYS_fcntl, descriptor, F_DUPFD_CLOEXEC, kHighDescriptor);
  if (high < 0) return descriptor;
  Syscall(SYS_close, descriptor);
  return static_cast<int>(high);
}

/// A descriptor of our file, even if the program closed all that it found open.
int Descriptor(StreamFile& file) {
  if (IsOurs(file, file.descriptor)) return file.descriptor;
  const long again = Syscall(SYS_open, Argument(file.path.text()), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
  if (again < 0) return static_cast<int>(again);
  const int descriptor = MoveUp(static_cast<int>(again));
  if (!IsOurs(file, descriptor)) {
    Syscall(SYS_close, descriptor);
    return -ESTALE;
  }
  return file.descriptor = descriptor;
}

/// Whether the program's file size limit allows it; going beyond would raise SIGXFSZ.
bool WithinLimit(std::uint64_t bytes) {
  rlimit limit{};
  if (Syscall(SYS_prlimit64, 0, RLIMIT_FSIZE, 0, Argument(&limit)) != 0) return true;
  return bytes <= limit.rlim_cur;
}

/// Writes zeros where the file system cannot allocate.
int WriteZeros(int descriptor, std::uint64_t from, std::uint64_t to) {
  static const char zeros[4096] = {};
  while (from < to) {
    const std::uint64_t left = to - from;
    const long bytes = static_cast<long>(left < sizeof zeros ? left : sizeof zeros);
    const long written =
        Syscall(SYS_pwrite64, descriptor, Argument(zeros), bytes, static_cast<long>(from));
    if (written == -EINTR) continue;
    if (written <= 0) return written == 0 ? ENOSPC : static_cast<int>(-written);
    from += static_cast<std::uint64_t>(written);
  }
  return 0;
}

int Allocate(int descriptor, std::uint64_t from, std::uint64_t to) {
  if (!WithinLimit(to)) return EFBIG;
  long result = 0;
  do
    result = Syscall(SYS_fallocate, descriptor, 0, static_cast<long>(from),
                     static_cast<long>(to - from));
  while (result == -EINTR);
  int error = static_cast<int>(-result);
  if (error == EOPNOTSUPP || error == ENOSYS) error = WriteZeros(descriptor, from, to);
  // A failed attempt may have taken what others need.
  if (error != 0) Syscall(SYS_ftruncate, descriptor, static_cast<long>(from));
  return error;
}

/// Grows the file so that `bytes` more can be taken; 0 or an errno.
int Grow(StreamFile& file, std::uint64_t bytes) {
  const int descriptor = Descriptor(file);
  if (descriptor < 0) return -descriptor;
  const std::uint64_t least = file.used + bytes;
  std::uint64_t end = file.closing ? least : file.allocated + file.next_extent_bytes;
  if (file.ahead_limit != 0 && end > file.ahead_limit) end = file.ahead_limit;
  if (end < least) end = least;
  int error = Allocate(descriptor, file.allocated, end);
  if (error != 0 && end != least) error = Allocate(descriptor, file.allocated, end = least);
  if (error != 0) return error;
  file.allocated = end;
  if (file.next_extent_bytes < kLargestExtentBytes) file.next_extent_bytes *= 2;
  return 0;
}

/// Maps all that is allocated and not yet taken; 0 or an errno.
int MapWindow(StreamFile& file) {
  const int descriptor = Descriptor(file);
  if (descriptor < 0) return -descriptor;
  const long window =
      Syscall(SYS_mmap, 0, static_cast<long>(file.allocated - file.used), PROT_READ | PROT_WRITE,
              MAP_SHARED, descriptor, static_cast<long>(file.used));
  if (IsError(window)) return static_cast<int>(-window);
  file.window = reinterpret_cast<char*>(window);
  file.window_begin = file.used;
  file.window_end = file.allocated;
  return 0;
}

/// `batch` is full: asks for an old one to be written, and drops one that was asked for long ago.
/// Neither waits for the disk.
void DropBehind(int descriptor, std::uint64_t batch) {
  constexpr long kStartWriting = 2, kNoNeed = 4;
  if (batch < kDirtyBatches) return;
  const auto start = static_cast<long>((batch - kDirtyBatches) * kBatchBytes);
  Syscall(SYS_sync_file_range, descriptor, start, kBatchBytes, kStartWriting);
  if (batch < kCachedBatches) return;
  const auto oldest = static_cast<long>((batch - kCachedBatches) * kBatchBytes);
  Syscall(SYS_fadvise64, descriptor, oldest, kBatchBytes, kNoNeed);
}

}  // namespace

int CreateFile(StreamFile& file, const char* archive, const char* host_name, std::uint32_t pid,
               std::uint64_t start_ns) {
  for (int attempt = 0; attempt < 100; ++attempt) {
    file.path = {};
    file.path.Add(archive).Add("/").Add(host_name).Add(".").Add(pid).Add(".");
    file.path.Add(start_ns + static_cast<std::uint64_t>(attempt)).Add(".stream");
    if (file.path.full()) return ENAMETOOLONG;
    const long made =
        Syscall(SYS_open, Argument(file.path.text()), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (made == -EEXIST) continue;
    if (made < 0) return static_cast<int>(-made);
    file.descriptor = MoveUp(static_cast<int>(made));
    struct stat status {};
    Syscall(SYS_fstat, file.descriptor, Argument(&status));
    file.device = status.st_dev;
    file.inode = status.st_ino;
    file.next_extent_bytes = kFirstExtentBytes;
    return 0;
  }
  return EEXIST;
}

bool TakePlace(StreamFile& file, std::size_t bytes, std::uint64_t* offset, int* error) {
  *error = file.used + bytes > file.allocated ? Grow(file, bytes) : 0;
  if (*error != 0) return false;
  *offset = file.used;
  file.used += bytes;
  return true;
}

char* TakeBytes(StreamFile& file, std::size_t bytes, int* error) {
  *error = file.used + bytes > file.allocated ? Grow(file, bytes) : 0;
  if (*error == 0 && file.used + bytes > file.window_end) *error = MapWindow(file);
  if (*error != 0) return nullptr;
  char* taken = file.window + (file.used - file.window_begin);
  file.used += bytes;
  return taken;
}

int WriteBytes(StreamFile& file, std::uint64_t offset, const char* from, std::size_t bytes) {
  const int descriptor = Descriptor(file);
  if (descriptor < 0) return -descriptor;
  const std::uint64_t first_batch = offset / kBatchBytes;
  while (bytes > 0) {
    const long written = Syscall(SYS_pwrite64, descriptor, Argument(from), static_cast<long>(bytes),
                                 static_cast<long>(offset));
    if (written == -EINTR) continue;
    if (written <= 0) return written == 0 ? EIO : static_cast<int>(-written);
    offset += static_cast<std::uint64_t>(written);
    from += written;
    bytes -= static_cast<std::size_t>(written);
  }
  if (offset / kBatchBytes != first_batch) DropBehind(descriptor, first_batch);
  return 0;
}

void TrimFile(StreamFile& file) {
  file.closing = true;
  if (file.allocated == file.used) return;
  const int descriptor = Descriptor(file);
  if (descriptor < 0) return;
  if (Syscall(SYS_ftruncate, descriptor, static_cast<long>(file.used)) == 0)
    file.allocated = file.used;
}

}  // namespace stipple
