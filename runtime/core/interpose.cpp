// SPDX-License-Identifier: MIT
// Ends that libc does not announce: _exit, quick_exit, abort and exec, noted on their way to libc.
// Only in the shared library; a static program's ends other than exit look like a kill.
#include <dlfcn.h>
#include <stdarg.h>
#include <stdlib.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "runtime/core/process.h"
#include "runtime/core/recorder.h"

namespace {

using stipple::Ending;
using stipple::NoteEnd;

constexpr int kAbortStatus = 6;  // SIGABRT

template <class Function>
Function* Next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

template <class Function, class... Arguments>
int Execute(const char* name, Arguments... arguments) {
  auto* real = Next<Function>(name);
  if (real == nullptr) return -1;
  NoteEnd(Ending::kExec, 0);
  const int result = real(arguments...);
  stipple::RetractEnd();
  return result;
}

/// Counts the arguments of execl and its like, the terminator excluded.
std::size_t CountArguments(const char* first, va_list rest) {
  std::size_t count = 0;
  for (const char* argument = first; argument != nullptr; argument = va_arg(rest, const char*))
    ++count;
  return count;
}

void CopyArguments(char** to, const char* first, va_list rest) {
  for (const char* argument = first; argument != nullptr; argument = va_arg(rest, const char*))
    *to++ = const_cast<char*>(argument);
  *to = nullptr;
}

}  // namespace

// Puts the variable arguments behind `first` into `arguments`, on the stack.
#define STIPPLE_GATHER(arguments, first)                                                          \
  va_list stipple_list;                                                                           \
  va_start(stipple_list, first);                                                                  \
  const std::size_t stipple_count = CountArguments(first, stipple_list);                          \
  va_end(stipple_list); /* NOLINTNEXTLINE(bugprone-macro-parentheses): a name that is declared */ \
  auto** arguments = static_cast<char**>(__builtin_alloca((stipple_count + 1) * sizeof(char*)));  \
  va_start(stipple_list, first);                                                                  \
  CopyArguments(arguments, first, stipple_list)

#define STIPPLE_EXPORT __attribute__((visibility("default")))

extern "C" {

STIPPLE_EXPORT void _exit(int status) {
  NoteEnd(Ending::kImmediateExit, status);
  if (auto* real = Next<void(int)>("_exit")) real(status);
  for (;;) stipple::Syscall(SYS_exit_group, status);
}

STIPPLE_EXPORT void _Exit(int status) { _exit(status); }

STIPPLE_EXPORT void quick_exit(int status) noexcept {
  NoteEnd(Ending::kImmediateExit, status);
  if (auto* real = Next<void(int)>("quick_exit")) real(status);
  for (;;) stipple::Syscall(SYS_exit_group, status);
}

STIPPLE_EXPORT void abort() noexcept {
  NoteEnd(Ending::kAbort, kAbortStatus);
  if (auto* real = Next<void()>("abort")) real();
  for (;;) __builtin_trap();
}

STIPPLE_EXPORT int execve(const char* path, char* const argv[], char* const envp[]) noexcept {
  return Execute<decltype(execve)>("execve", path, argv, envp);
}
STIPPLE_EXPORT int execv(const char* path, char* const argv[]) noexcept {
  return Execute<decltype(execv)>("execv", path, argv);
}
STIPPLE_EXPORT int execvp(const char* file, char* const argv[]) noexcept {
  return Execute<decltype(execvp)>("execvp", file, argv);
}
STIPPLE_EXPORT int execvpe(const char* file, char* const argv[], char* const envp[]) noexcept {
  return Execute<decltype(execvpe)>("execvpe", file, argv, envp);
}
STIPPLE_EXPORT int fexecve(int descriptor, char* const argv[], char* const envp[]) noexcept {
  return Execute<decltype(fexecve)>("fexecve", descriptor, argv, envp);
}
STIPPLE_EXPORT int execl(const char* path, const char* first, ...) noexcept {
  STIPPLE_GATHER(arguments, first);
  va_end(stipple_list);
  return execv(path, arguments);
}
STIPPLE_EXPORT int execlp(const char* file, const char* first, ...) noexcept {
  STIPPLE_GATHER(arguments, first);
  va_end(stipple_list);
  return execvp(file, arguments);
}
STIPPLE_EXPORT int execle(const char* path, const char* first, ...) noexcept {
  va_list rest;
  va_start(rest, first);
  const std::size_t count = CountArguments(first, rest);
  va_end(rest);
  auto** arguments = static_cast<char**>(__builtin_alloca((count + 1) * sizeof(char*)));
  va_start(rest, first);
  CopyArguments(arguments, first, rest);
  va_end(rest);
  va_start(rest, first);
  for (std::size_t i = 0; i < count; ++i) va_arg(rest, char*);  // the last is the terminator
  char** environment = va_arg(rest, char**);
  va_end(rest);
  return execve(path, arguments, environment);
}
}
