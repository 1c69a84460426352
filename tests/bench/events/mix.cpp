// SPDX-License-Identifier: MIT
// What programs are made of: virtual methods in floating point, a hash of 64 bytes, calls three
// deep; about 90 ns a visit. No call is a plain one's last act: what it costs that a function with
// a leave cannot end in a jump is not measured here.
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "kernel.h"

namespace {

struct Shape {
  virtual ~Shape() = default;
  virtual double Weight(double x) const = 0;
};

struct Polynomial : Shape {
  double coefficients[72];
  Polynomial() {
    for (int i = 0; i < 72; ++i) coefficients[i] = 1.0 / (i + 1);
  }
  double Weight(double x) const override {
    FLOOR_ENTER();
    double sum = 0;
    for (const double c : coefficients) sum = sum * x + c;
    FLOOR_LEAVE();
    return sum;
  }
};

struct Wave : Shape {
  double Weight(double x) const override {
    FLOOR_ENTER();
    double sum = x;
    for (int i = 1; i < 28; ++i) sum = std::sqrt(sum * sum + i);
    FLOOR_LEAVE();
    return sum;
  }
};

std::uint64_t Hash(const unsigned char (&bytes)[64]) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3;
  return hash;
}

__attribute__((noinline)) std::uint64_t HashOf(std::uint64_t value) {
  FLOOR_ENTER();
  unsigned char bytes[64];
  for (int i = 0; i < 64; ++i) bytes[i] = static_cast<unsigned char>(value >> (i % 8));
  std::uint64_t hash = 0;
  for (int i = 0; i < 3; ++i) hash = Hash(bytes) ^ (bytes[i] = static_cast<unsigned char>(hash));
  FLOOR_LEAVE();
  return hash;
}

__attribute__((noinline)) double Inner(const Shape& shape, std::uint64_t value) {
  FLOOR_ENTER();
  const double weight = 0.5 * shape.Weight(double(value % 100) * 0.01);
  FLOOR_LEAVE();
  return weight;
}

__attribute__((noinline)) double Middle(const Shape& shape, std::uint64_t value) {
  FLOOR_ENTER();
  const double weight = Inner(shape, value) + Inner(shape, value + 1);
  FLOOR_LEAVE();
  return weight;
}

}  // namespace

std::uint64_t kernel_run(std::uint64_t calls) {
  static const std::unique_ptr<Shape> shapes[] = {std::make_unique<Polynomial>(),
                                                  std::make_unique<Wave>()};
  std::uint64_t sum = 0;
  for (std::uint64_t i = 0; i < calls; i += 6)  // six visits a round
    sum += HashOf(i) + static_cast<std::uint64_t>(Middle(*shapes[i / 6 % 2], i));
  return sum;
}
