// SPDX-License-Identifier: MIT
// Files with code, as mapped: which one holds an address. For functions that bring no descriptor
// (-finstrument-functions).
#ifndef STIPPLE_RUNTIME_CORE_MODULE_H
#define STIPPLE_RUNTIME_CORE_MODULE_H

#include <cstdint>

#include "runtime/core/process.h"

namespace stipple {

/// A file mapped at one place, once; never freed. Files with the same path and build-id have the
/// same number.
struct Module {
  std::uint32_t number;  // DefineModule
  bool mapped;
  std::uintptr_t begin, end;
  std::uint64_t load_bias;  // of addresses against those in the file
  std::uint64_t device, inode;
  const char* path;
  const char* build_id;  // bytes
  std::uint32_t path_bytes;
  std::uint32_t build_id_bytes;  // 0: none
  std::uintptr_t build_id_at;    // where it is mapped
  Module* next;
};

/// The module that holds the code at `address`, defined at first use; null if no ELF file does. The
/// lock is held.
Module* ModuleAt(Process& process, std::uintptr_t address);

/// The one that was known to hold `address`, or null.
Module* KnownModuleAt(std::uintptr_t address);

/// Whether it is still where it was. If not, it is known to be gone from now on.
bool StillMapped(Module& module);

/// The newest module; the others by `next`.
Module* Modules();

/// Writes the definition of every module there is. The lock is held.
void DefineModules(Process& process);

}  // namespace stipple

#endif
