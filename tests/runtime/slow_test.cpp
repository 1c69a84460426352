// SPDX-License-Identifier: MIT
// The jump into the slow path: every register comes back.
#include <cpuid.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
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
/// MXCSR and the x87's control word, two words each.
std::uint32_t slow_control_words(void (*slow)(), std::uint32_t token, const std::uint32_t* from,
                                 std::uint32_t* to);
/// zmm0-31 and k0-7, 2112 bytes each.
std::uint32_t slow_zmm(void (*slow)(), std::uint32_t token, const void* from, void* to);
/// Tile 0 under a configuration of 64 bytes, 1024 bytes each.
std::uint32_t slow_tiles(void (*slow)(), std::uint32_t token, const void* configuration,
                         const void* from, void* to);
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

/// Bytes that differ.
template <std::size_t kBytes>
void Fill(std::array<unsigned char, kBytes>& bytes, std::uint32_t seed) {
  for (std::size_t i = 0; i < kBytes; ++i)
    bytes[i] = static_cast<unsigned char>(i * 41 + i / 256 + seed);
}

/// Whether the processor has tiles and the kernel lets this process use them.
bool MayUseTiles() {
  unsigned a = 0, b = 0, c = 0, d = 0;
  constexpr unsigned kAmxTile = 1u << 24;
  if (__get_cpuid_count(7, 0, &a, &b, &c, &d) == 0 || (d & kAmxTile) == 0) return false;
  constexpr long kRequestPermission = 0x1023, kTileData = 18;
  return syscall(SYS_arch_prctl, kRequestPermission, kTileData) == 0;
}

class Slow : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    archive_ = new stipple_test::Directory;
    setenv("STIPPLE_ARCHIVE", archive_->path().c_str(), 1);
    setenv("STIPPLE_CLOCK", "exact", 1);
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
  const Row rows[] = {
      {id, id},
      {id | STIPPLE_LEAVE, id | STIPPLE_LEAVE},
      {id | STIPPLE_NO_CLOCK, id | STIPPLE_SAMPLED},  // the first visit is a sample
      {id | STIPPLE_SAMPLED | STIPPLE_LEAVE, id | STIPPLE_SAMPLED | STIPPLE_LEAVE},
      {id | STIPPLE_NO_CLOCK, id | STIPPLE_NO_CLOCK},
      {id | STIPPLE_NO_CLOCK | STIPPLE_LEAVE, id | STIPPLE_NO_CLOCK | STIPPLE_LEAVE},
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
      constexpr std::uint32_t kNumber = ~std::uint32_t{0} << STIPPLE_SAMPLED_SHIFT;
      EXPECT_EQ(slow_registers(object_->dso.slow, row.token, &from, &to, wide) & ~kNumber,
                row.expected);
      for (int i = 0; i < 13; ++i) EXPECT_EQ(to.general[i], from.general[i]) << i;
      const std::size_t width = wide != 0 ? 32 : 16;
      for (int i = 0; i < 16; ++i)
        EXPECT_EQ(std::memcmp(to.vectors[i], from.vectors[i], width), 0) << "vector " << i;
      EXPECT_EQ(std::memcmp(to.x87, from.x87, 10), 0);
    }
}

TEST_F(Slow, ControlWordsComeBack) {
  const std::uint32_t id = object_->descriptors[0].id;
  const std::uint32_t from[2] = {0x7fbf, 0x0f7f};  // rounding, masks, and what had happened
  for (const std::uint32_t token : {id, id | STIPPLE_LEAVE}) {
    ExhaustChunk(object_->dso);
    std::uint32_t to[2] = {};
    EXPECT_EQ(slow_control_words(object_->dso.slow, token, from, to), token);
    EXPECT_EQ(to[0], from[0]);
    EXPECT_EQ(to[1], from[1]);
  }
}

TEST_F(Slow, AProgramThatTrapsInexactResultsIsNotTrappedHere) {
  const std::uint32_t id = object_->descriptors[0].id;
  const std::uint32_t from[2] = {0x0f80, 0x037f};  // precision unmasked
  std::uint32_t to[2] = {};
  ExhaustChunk(object_->dso);
  EXPECT_EQ(slow_control_words(object_->dso.slow, id, from, to), id);
  EXPECT_EQ(to[0], from[0]);
}

TEST_F(Slow, WideVectorsAndMasksComeBack) {
  if (!__builtin_cpu_supports("avx512bw")) GTEST_SKIP() << "the processor has no AVX-512";
  const std::uint32_t id = object_->descriptors[0].id;
  for (const std::uint32_t token : {id, id | STIPPLE_LEAVE}) {
    ExhaustChunk(object_->dso);
    std::array<unsigned char, 2112> from{}, to{};
    Fill(from, token);
    EXPECT_EQ(slow_zmm(object_->dso.slow, token, from.data(), to.data()), token);
    EXPECT_EQ(from, to);
  }
}

TEST_F(Slow, TilesAreLeftAlone) {
  if (!MayUseTiles()) GTEST_SKIP() << "the processor has no AMX, or the kernel does not give it";
  const std::uint32_t id = object_->descriptors[0].id;
  std::array<unsigned char, 64> configuration{};
  configuration[0] = 1;    // palette
  configuration[16] = 64;  // bytes per row of tile 0
  configuration[48] = 16;  // its rows
  for (const std::uint32_t token : {id, id | STIPPLE_LEAVE}) {
    ExhaustChunk(object_->dso);
    std::array<unsigned char, 1024> from{}, to{};
    Fill(from, token);
    EXPECT_EQ(slow_tiles(object_->dso.slow, token, configuration.data(), from.data(), to.data()),
              token);
    EXPECT_EQ(from, to);
  }
}

}  // namespace
