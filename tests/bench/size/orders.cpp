// SPDX-License-Identifier: MIT
// A program that is mostly templates: orders become JSON, text, JSON again and tables, by
// nlohmann-json and fmt, which are compiled as the program's own headers. ./run bench size measures
// what the plugin adds to it; the argument is how many orders there are.
#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace {

template <class Unit>
struct Amount {
  double value = 0;
  friend Amount operator+(Amount a, Amount b) { return {a.value + b.value}; }
  friend Amount operator*(Amount a, double factor) { return {a.value * factor}; }
};
struct Euro {};
struct Kilogram {};

template <class Unit>
void to_json(nlohmann::json& json, const Amount<Unit>& amount) {
  json = amount.value;
}
template <class Unit>
void from_json(const nlohmann::json& json, Amount<Unit>& amount) {
  json.get_to(amount.value);
}

struct Item {
  std::string name;
  Amount<Euro> price;
  Amount<Kilogram> weight;
  std::vector<int> sizes;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Item, name, price, weight, sizes)

struct Order {
  std::uint64_t number = 0;
  std::string customer;
  std::vector<Item> items;
  std::map<std::string, double> rebates;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Order, number, customer, items, rebates)

Order MakeOrder(std::uint64_t number) {
  Order order{number, fmt::format("customer {:05}", number * 7919 % 1000), {}, {}};
  for (std::uint64_t i = 0; i <= number % 4; ++i)
    order.items.push_back({fmt::format("item {}-{}", number, i),
                           {double(number % 97) + 0.25},
                           {double(i) * 0.5},
                           {int(i), int(number % 10), int(i * number % 13)}});
  order.rebates = {{"season", 0.1}, {"loyalty", double(number % 3) / 100}};
  return order;
}

/// Sums over items whatever `pick` gives of one.
template <class Unit, class Pick>
Amount<Unit> Total(const Order& order, Pick pick) {
  Amount<Unit> sum;
  for (const Item& item : order.items) sum = sum + pick(item);
  for (const auto& [name, rebate] : order.rebates) sum = sum * (1 - rebate);
  return sum;
}

template <class Key, class Value>
using Groups = std::map<Key, std::vector<Value>>;

template <class Key, class Values, class KeyOf>
auto GroupBy(const Values& values, KeyOf key_of) {
  Groups<Key, typename Values::value_type> groups;
  for (const auto& value : values) groups[key_of(value)].push_back(value);
  return groups;
}

using Cell = std::variant<std::uint64_t, double, std::string>;

std::string Text(const Cell& cell) {
  return std::visit([](const auto& value) { return fmt::format("{:>12}", value); }, cell);
}

template <class... Values>
std::string Row(const Values&... values) {
  const std::vector<Cell> cells{Cell(values)...};
  return std::accumulate(cells.begin(), cells.end(), std::string(),
                         [](std::string row, const Cell& c) { return std::move(row) + Text(c); });
}

std::vector<Order> ThroughText(const std::vector<Order>& orders) {
  const std::string text = nlohmann::json(orders).dump(1);
  return nlohmann::json::parse(text).get<std::vector<Order>>();
}

}  // namespace

int main(int argc, char** argv) {
  const auto count = std::uint64_t(argc > 1 ? std::atoi(argv[1]) : 100);
  std::vector<Order> orders;
  for (std::uint64_t i = 0; i < count; ++i) orders.push_back(MakeOrder(i));
  orders = ThroughText(orders);
  std::size_t bytes = 0;
  for (const auto& [customer, theirs] :
       GroupBy<std::string>(orders, [](const Order& order) { return order.customer; })) {
    for (const Order& order : theirs) {
      bytes += Row(order.number, customer,
                   Total<Euro>(order, [](const Item& item) { return item.price; }).value,
                   Total<Kilogram>(order, [](const Item& item) { return item.weight; }).value)
                   .size();
      bytes += fmt::format("{}\n", fmt::join(order.items.front().sizes, ", ")).size();
    }
  }
  std::printf("%zu bytes of tables\n", bytes);
}
