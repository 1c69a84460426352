// SPDX-License-Identifier: MIT
// The jump into the slow path: every register comes back.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <cstring>

#include "events.h"
#include "run_writer.h"

namespace {

using stipple_test::Object;

constexpr const char* kNames[] = {"leaf"};

/// Registers before and after a jump into the slow path, as slow_registers.S lays them out.
struct Registers {
  std::uint64_t general[13];  // rbx rcx rsi rdi r8-r10 r12-r15 rbp, and the red zone's first word
  std::uint64_t pad[3];
  unsigned char vectors[16][32];
  unsigned char x87[16];
};

}  // namespace

extern "C" {
/// Loads registers from `from`, jumps to `slow` with `token`, stores them to `to`; the token that
/// came back. With `wide` the vectors are ymm, else xmm.
std::uint32_t slow_registers(void (*slow)(), std::uint32_t token, const Registers* from,
                             Registers* to, std::uint32_t wide);
}

namespace {

/// Empties the stream's chunk, so that the next event needs a new one.
void ExhaustChunk(const stipple_dso& dso) {
  std::uint64_t thread_pointer = 0;
  __asm__("movq %%fs:0, %0" : "=r"(thread_pointer));
  auto* control = *reinterpret_cast<stipple_control**>(thread_pointer +
                                                       static_cast<std::uint64_t>(dso.tp_offset));
  control->cur = control->end;
}

class Slow : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    archive_ = new stipple_test::Directory;
    setenv("STIPPLE_ARCHIVE", archive_->path().c_str(), 1);
    object_ = new Object<1>(kNames);
  }
  static void TearDownTestSuite() { delete archive_; }
  static stipple_test::Directory* archive_;
  static Object<1>* object_;
};
stipple_test::Directory* Slow::archive_ = nullptr;
Object<1>* Slow::object_ = nullptr;

TEST_F(Slow, EveryRegisterComesBack) {
  const std::uint32_t id = object_->descriptors[0].id;
  ASSERT_NE(id, 0u);
  struct Row {
    std::uint32_t token, expected;
  };
  const Row rows[] = {{id, id},
                      {id | STIPPLE_LEAVE, id | STIPPLE_LEAVE},
                      {id | STIPPLE_NO_CLOCK, id | STIPPLE_NO_CLOCK},
                      {id | STIPPLE_COUNT_ONLY, 0},
                      {id | STIPPLE_COUNT_ONLY, 0}};
  const std::uint32_t wide = __builtin_cpu_supports("avx") ? 1 : 0;
  for (const Row& row : rows)
    for (const bool exhausted : {true, false}) {
      if (exhausted) ExhaustChunk(object_->dso);
      Registers from{}, to{};
      auto* bytes = reinterpret_cast<unsigned char*>(&from);
      for (std::size_t i = 0; i < sizeof from; ++i)
        bytes[i] = static_cast<unsigned char>(i * 37 + row.token + 11);
      const long double number = 1.25L;
      std::memcpy(from.x87, &number, 10);
      EXPECT_EQ(slow_registers(object_->dso.slow, row.token, &from, &to, wide), row.expected);
      for (int i = 0; i < 13; ++i) EXPECT_EQ(to.general[i], from.general[i]) << i;
      const std::size_t width = wide != 0 ? 32 : 16;
      for (int i = 0; i < 16; ++i)
        EXPECT_EQ(std::memcmp(to.vectors[i], from.vectors[i], width), 0) << "vector " << i;
      EXPECT_EQ(std::memcmp(to.x87, from.x87, 10), 0);
    }
}

}  // namespace
