// SPDX-License-Identifier: MIT
#include "analysis/tools/process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

namespace stipple {
namespace {

std::atomic<pid_t> child_pid{0};

/// What a terminal sends reaches the child by itself; what a process sends is meant for it too.
void PassOn(int signal, siginfo_t* info, void*) {
  const pid_t child = child_pid.load();
  if (child > 0 && info->si_code != SI_KERNEL) kill(child, signal);
}

constexpr std::array kPassedOn = {SIGHUP,  SIGINT,  SIGQUIT, SIGTERM, SIGUSR1,
                                  SIGUSR2, SIGALRM, SIGCONT, SIGWINCH};

std::vector<char*> Argv(const std::vector<std::string>& command) {
  std::vector<char*> argv;
  for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  return argv;
}

int WaitFor(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

std::atomic<bool> told_to_end{false};

void NoteEnd(int) { told_to_end = true; }

}  // namespace

const std::atomic<bool>& StopOnSignals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction old = {};
    sigaction(signal, nullptr, &old);
    struct sigaction action = {};
    action.sa_handler = NoteEnd;
    action.sa_flags = SA_RESTART;
    if (old.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
  return told_to_end;
}

std::optional<std::string> OutputOf(const std::vector<std::string>& command) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return std::nullopt;
  const std::vector<char*> argv = Argv(command);
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDOUT_FILENO);
    const int null = open("/dev/null", O_RDWR | O_CLOEXEC);
    dup2(null, STDERR_FILENO);
    dup2(null, STDIN_FILENO);
    execvp(argv[0], argv.data());
    _exit(127);
  }
  close(ends[1]);
  std::string output;
  std::array<char, 4096> buffer{};
  for (ssize_t n = 0; (n = read(ends[0], buffer.data(), buffer.size())) > 0;)
    output.append(buffer.data(), static_cast<std::size_t>(n));
  close(ends[0]);
  if (child < 0 || WaitFor(child) != 0) return std::nullopt;
  return output;
}

int RunQuietly(const std::vector<std::string>& command, const std::string& said) {
  const std::vector<char*> argv = Argv(command);
  const char* path = said.c_str();
  const pid_t child = fork();
  if (child == 0) {
    const int file = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    const int null = open("/dev/null", O_RDONLY | O_CLOEXEC);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    dup2(null, STDIN_FILENO);
    execv(argv[0], argv.data());
    _exit(127);
  }
  return child < 0 ? 127 : WaitFor(child);
}

int RunToEnd(const std::vector<std::string>& command, int ignored) {
  const std::vector<char*> argv = Argv(command);
  sigset_t passed_on;
  sigset_t before;
  sigemptyset(&passed_on);
  for (const int signal : kPassedOn) sigaddset(&passed_on, signal);
  // Held back until there is someone to pass them on to.
  sigprocmask(SIG_BLOCK, &passed_on, &before);
  const pid_t child = fork();
  if (child == 0) {
    if (ignored != 0) signal(ignored, SIG_IGN);
    sigprocmask(SIG_SETMASK, &before, nullptr);
    execvp(argv[0], argv.data());
    const int error = errno;
    fmt::print(stderr, "stipple run: {}: {}\n", command.front(), std::strerror(error));
    _exit(error == ENOENT ? 127 : 126);
  }
  if (child < 0) {
    fmt::print(stderr, "stipple run: {}\n", std::strerror(errno));
    sigprocmask(SIG_SETMASK, &before, nullptr);
    return 126;
  }
  child_pid = child;
  struct sigaction action = {};
  action.sa_sigaction = PassOn;
  action.sa_flags = SA_SIGINFO | SA_RESTART;
  for (const int signal : kPassedOn) {
    struct sigaction old = {};
    sigaction(signal, nullptr, &old);
    if (old.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);  // as under nohup
  }
  sigprocmask(SIG_SETMASK, &before, nullptr);
  const int status = WaitFor(child);
  child_pid = 0;
  return status;
}

}  // namespace stipple
