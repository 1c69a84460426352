// SPDX-License-Identifier: MIT
#include "raytracer/render/divided.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <numeric>

#include "raytracer/partition/find_row.h"
#include "raytracer/partition/termination.h"
#include "raytracer/render/found_parts.h"
#include "raytracer/render/mail.h"
#include "raytracer/render/marks.h"
#include "raytracer/render/point_supply.h"
#include "raytracer/render/progress.h"
#include "raytracer/render/ray_package.h"

namespace stipple::raytracer {
namespace {

enum Tag : int {
  kRays = 10,  // RayPackage
  kCredit,     // packages of the receiver's have been worked off: Standing
  kFound,      // FoundParts, to the assembling rank
  kLast,       // the sender has found all it will
  kSignal,     // DetectorSignal
  kEnd,        // all is done, down the tree
  kAsk,        // for a bundle, to the host
  kGiven       // its number
};

// Packages that one rank may send to another before the first of them is worked off. Half of them
// are acknowledged at a time, or with the next package that goes back, or by who has nothing else
// to do.
constexpr std::size_t kCredits = 8;

/// A package with so many rays goes to who has no work though it is not full, so that in all of a
/// rank's packages lies at most about an eighth of the rays that it will see: five for each point.
std::size_t WorthSending(const DividedChoice& choice) {
  const auto ranks = static_cast<std::size_t>(choice.holders);
  const std::size_t rays = 5 * PointCount(choice.points.raster) / ranks;
  return std::clamp<std::size_t>(rays / 8 / std::max<std::size_t>(ranks - 1, 1), 1, choice.package);
}

// Rays between two looks for letters.
constexpr int kRaysPerLook = 16;

// No eye ray is begun while so many full packages cannot be sent: what is under way takes memory.
constexpr std::size_t kMostPackagesHere = 512;

/// Whether a part of the protocol is there. In the build for tests one can be taken away, to see
/// that it is missed.
#ifdef STIPPLE_BREAKABLE
bool Intact(std::string_view part) {
  const char* broken = std::getenv("STIPPLE_BREAK");
  return broken == nullptr || part != broken;
}
#else
constexpr bool Intact(std::string_view) { return true; }
#endif
constexpr std::string_view kPartFull = "part-full packages";
constexpr std::string_view kAgreement = "agreement";  // of a second round, and of the other method

/// Detectors by number: each sees its own signals only.
struct DetectorSignal {
  std::int32_t detector;
  Signal signal;
};

/// The picture, on the rank that has it.
class Assembly {
 public:
  explicit Assembly(const PartitionChoice& choice) : raster_(PointCount(choice.raster)) {}

  void Take(const std::vector<FoundPart>& parts) {
    for (const FoundPart& part : parts) Merge(part.result, raster_[part.point]);
  }
  Raster TakeRaster() { return std::move(raster_); }
  int finished = 0;  // ranks that have sent all

 private:
  Raster raster_;
};

/// Rays that wait to be followed, the deepest first; rays to lights before all, as nothing comes of
/// them.
template <class Real>
class RayQueue {
 public:
  struct Waiting {
    Traveller<Real> ray;
    int from;  // rank that sent it, or -1
  };

  void Push(const Traveller<Real>& ray, int from) {
    const std::size_t depth = ray.to_light ? kDeepest + 1 : ray.depth;
    by_depth_[depth].push_back({ray, from});
    deepest_ = std::max(deepest_, depth);
    ++size_;
  }
  Waiting Pop() {
    while (by_depth_[deepest_].empty()) --deepest_;
    const Waiting waiting = by_depth_[deepest_].back();
    by_depth_[deepest_].pop_back();
    --size_;
    return waiting;
  }
  std::size_t size() const { return size_; }

 private:
  std::array<std::vector<Waiting>, kDeepest + 2> by_depth_;
  std::size_t deepest_ = 0, size_ = 0;
};

/// What lies between this rank and one other.
template <class Real>
struct Neighbour {
  std::deque<RayPackage<Real>> outgoing;  // all but the last are full
  std::deque<std::size_t> under_way;      // packages to it, not worked off: rays
  std::deque<std::size_t> packages;       // of it, not worked off: rays
  std::size_t followed = 0;               // rays of the first of them
  std::size_t held = 0;                   // its rays, not followed
  Standing standing;                      // that it has not been told of
  std::uint32_t told = 0;                 // rays that waited for it when it last told
  std::uint32_t was_told = 0;             // and here, when it was last told
};

template <class Real>
class Worker {
 public:
  Worker(const World& world, Mail& mail, RankTracer<Real>& tracer, const DividedChoice& choice)
      : world_(world),
        mail_(mail),
        tracer_(tracer),
        choice_(choice),
        row_(FindRow(kRayPartitions, choice.partition)),
        assembling_(AssemblingRank(world, choice.partition)),
        supply_(world, mail, row_, choice.points, kAsk),
        neighbours_(static_cast<std::size_t>(choice.holders)),
        waiting_(static_cast<std::size_t>(choice.holders)),
        four_counters_(world.rank, choice.holders, Intact(kAgreement) ? 2 : 1),
        safra_(world.rank, choice.holders),
        worth_sending_(WorthSending(choice)),
        progress_(PointCount(choice.points.raster) / static_cast<std::size_t>(choice.holders),
                  world.rank == 0) {
    if (world.rank == assembling_) assembly_.emplace(choice.points);
  }

  void Run() {
    int until_look = 0;
    while (!ended_) {
      if (until_look-- == 0) {
        while (TakeLetter(false)) {
        }
        SendToWaiting();
        until_look = kRaysPerLook;
      }
      if (FollowOne() || BeginPoint()) continue;
      SendRest();
      Detect([this](auto& detector, const RankState& state, Signals& out) {
        detector.Advance(state, out);
      });
      if (!ended_ && queue_.size() == 0 && (supply_.left() == 0 || HoldsMany())) TakeLetter(true);
      until_look = 0;
    }
    Finish();
  }

  Raster TakeRaster() { return assembly_ ? assembly_->TakeRaster() : Raster(); }
  const TravelCounts& travel() const { return travel_; }

 private:
  bool HasWork() const { return queue_.size() > 0 || supply_.left() > 0; }
  bool HoldsMany() const { return full_here_ >= kMostPackagesHere; }

  /// False if there is no ray here.
  bool FollowOne() {
    if (queue_.size() == 0) return false;
    auto [ray, from] = queue_.Pop();
    if (from >= 0) --neighbours_[static_cast<std::size_t>(from)].held;
    more_.clear();
    RayResult found;
    const RasterPoint point = ray.point;
    waiting_[static_cast<std::size_t>(world_.rank)] = queue_.size();
    const int next = tracer_.Advance(ray, waiting_, more_, found);
    if (next != RankTracer<Real>::kEnded) Forward(ray, next);
    for (const Traveller<Real>& one : more_) queue_.Push(one, -1);
    travel_.most_held = std::max<std::uint64_t>(travel_.most_held, queue_.size());
    Keep(point, found);
    if (from >= 0) Acknowledge(from);
    return true;
  }

  bool BeginPoint() {
    if (HoldsMany()) return false;
    const std::optional<RasterPoint> point = supply_.Next();
    if (!point) return false;
    RayResult found;
    more_.clear();
    tracer_.Begin(*point, more_, found);
    for (const Traveller<Real>& ray : more_) queue_.Push(ray, -1);
    Keep(*point, found);
    progress_.Advance(1);
    if (supply_.left() == 0) Record();
    return true;
  }

  void Forward(const Traveller<Real>& ray, int to) {
    Neighbour<Real>& neighbour = neighbours_[static_cast<std::size_t>(to)];
    if (neighbour.outgoing.empty() || IsFull(neighbour.outgoing.back()))
      neighbour.outgoing.emplace_back();
    neighbour.outgoing.back().Add(ray);
    ++waiting_[static_cast<std::size_t>(to)];
    if (!IsFull(neighbour.outgoing.back())) return;
    ++full_here_;
    SendFull(to);
  }

  bool IsFull(const RayPackage<Real>& package) const { return package.rays() == choice_.package; }

  /// As many as the receiver may get.
  void SendFull(int to) {
    Neighbour<Real>& neighbour = neighbours_[static_cast<std::size_t>(to)];
    while (!neighbour.outgoing.empty() && IsFull(neighbour.outgoing.front()) &&
           neighbour.under_way.size() < kCredits)
      SendPackage(to);
  }

  void Record() const {
    RecordCounts(tracer_.counts());
    RecordTravel(queue_.size(), travel_.rays_received, travel_.rays_sent);
  }

  void SendPackage(int to) {
    Neighbour<Real>& neighbour = neighbours_[static_cast<std::size_t>(to)];
    RayPackage<Real>& package = neighbour.outgoing.front();
    mail_.Post(to, kRays, package.Ready(StandingFor(neighbour)));
    neighbour.under_way.push_back(package.rays());
    ++travel_.packages_sent;
    travel_.rays_sent += package.rays();
    if (IsFull(package)) --full_here_;
    neighbour.outgoing.pop_front();
    Record();
  }

  /// To those who have worked off all that they have got of this rank and told of no other work.
  void SendToWaiting() {
    for (int to = 0; to < choice_.holders; ++to) {
      const Neighbour<Real>& neighbour = neighbours_[static_cast<std::size_t>(to)];
      if (!neighbour.outgoing.empty() && neighbour.under_way.empty() &&
          neighbour.told < Holding::kManyRays &&
          neighbour.outgoing.front().rays() >= worth_sending_ && Intact(kPartFull))
        SendPackage(to);
    }
  }

  /// Packages that are not full, too, as nothing else will come to fill them: to those who have
  /// worked off all that they have got of this rank. Others have work, and will tell when not.
  void SendRest() {
    for (int to = 0; to < choice_.holders; ++to) {
      Neighbour<Real>& neighbour = neighbours_[static_cast<std::size_t>(to)];
      if (!neighbour.outgoing.empty() && neighbour.under_way.empty() && Intact(kPartFull))
        SendPackage(to);
      SendCredit(to);
    }
  }

  /// What was worked off, or that there is no work left here.
  void SendCredit(int to) {
    Neighbour<Real>& neighbour = neighbours_[static_cast<std::size_t>(to)];
    const bool news = neighbour.was_told >= Holding::kManyRays && queue_.size() == 0;
    if (neighbour.standing.worked_off > 0 || news) mail_.Post(to, kCredit, StandingFor(neighbour));
  }

  Standing StandingFor(Neighbour<Real>& neighbour) const {
    Standing standing = std::exchange(neighbour.standing, {});
    standing.waiting = static_cast<std::uint32_t>(queue_.size() - neighbour.held);
    neighbour.was_told = standing.waiting;
    return standing;
  }

  void TakeStanding(int from, const Standing& standing) {
    Neighbour<Real>& neighbour = neighbours_[static_cast<std::size_t>(from)];
    std::uint64_t& waiting = waiting_[static_cast<std::size_t>(from)];
    for (std::uint32_t package = 0; package < standing.worked_off; ++package) {
      waiting -= neighbour.under_way.front();
      neighbour.under_way.pop_front();
    }
    waiting += standing.waiting;
    waiting -= std::exchange(neighbour.told, standing.waiting);
    SendFull(from);
  }

  void Acknowledge(int from) {
    Neighbour<Real>& neighbour = neighbours_[static_cast<std::size_t>(from)];
    if (++neighbour.followed < neighbour.packages.front()) return;
    neighbour.followed = 0;
    neighbour.packages.pop_front();
    if (++neighbour.standing.worked_off == kCredits / 2) SendCredit(from);
  }

  void Keep(RasterPoint point, const RayResult& found) {
    found_.Add(point, found);
    if (found_.full()) SendFound();
  }
  void SendFound() {
    if (assembly_)
      assembly_->Take(found_.parts());
    else if (!found_.empty())
      mail_.Post(assembling_, kFound, std::span<const FoundPart>(found_.parts()));
    found_.Clear();
  }

  RankState State() const {
    RankState state{!HasWork() && supply_.ended(), 0, 0};
    for (const Neighbour<Real>& neighbour : neighbours_)
      if (!neighbour.outgoing.empty()) state.passive = false;
    state.sent = static_cast<std::int64_t>(travel_.packages_sent);
    state.received = static_cast<std::int64_t>(packages_received_);
    return state;
  }

  template <class Do>
  void Detect(Do what) {
    const auto detect = [&](std::int32_t number, auto& detector) {
      Signals out;
      what(detector, State(), out);
      for (const Signal& signal : out)
        mail_.Post(signal.to, kSignal, DetectorSignal{number, signal});
    };
    detect(0, four_counters_);
    detect(1, safra_);
    if (EndIsFound()) End();
  }

  bool EndIsFound() const {
    return world_.rank == 0 && four_counters_.ended() && (safra_.ended() || !Intact(kAgreement));
  }

  void End() {
    if (ended_) return;
    for (int child = 2 * world_.rank + 1; child <= 2 * world_.rank + 2; ++child)
      if (child < choice_.holders) mail_.Post(child, kEnd, std::span<const std::byte>());
    ended_ = true;
    if (!State().passive) StopAll("work is left although its end was found");
  }

  [[noreturn]] void StopAll(std::string_view problem) const {
    fmt::print(stderr, "raytracer: rank {}: {}; this is a bug\n", world_.rank, problem);
    MPI_Abort(world_.comm, 3);
    std::abort();
  }

  bool TakeLetter(bool wait) {
    Letter letter;
    if (!mail_.Take(wait, letter)) return false;
    switch (static_cast<Tag>(letter.tag)) {
      case kRays:
        TakeRays(letter);
        break;
      case kCredit:
        TakeStanding(letter.from, letter.Of<Standing>().front());
        break;
      case kFound:
        assembly_->Take(letter.Of<FoundPart>());
        break;
      case kLast:
        ++assembly_->finished;
        break;
      case kSignal:
        TakeSignal(letter.Of<DetectorSignal>().front());
        break;
      case kEnd:
        End();
        break;
      case kGiven:
        supply_.Given(letter.Of<std::uint32_t>().front());
        break;
      case kAsk:
        break;  // only the host is asked
    }
    return true;
  }

  void TakeRays(const Letter& letter) {
    if (ended_) StopAll("rays came after their end was found");
    const PackageHeader header = Unpack(letter.body, tracer_, more_);
    for (const Traveller<Real>& ray : more_) queue_.Push(ray, letter.from);
    Neighbour<Real>& neighbour = neighbours_[static_cast<std::size_t>(letter.from)];
    neighbour.packages.push_back(more_.size());
    neighbour.held += more_.size();
    ++packages_received_;
    travel_.rays_received += more_.size();
    travel_.most_held = std::max<std::uint64_t>(travel_.most_held, queue_.size());
    TakeStanding(letter.from, header.standing);
    Record();
  }

  void TakeSignal(const DetectorSignal& signal) {
    Signals out;
    const RankState state = State();
    if (signal.detector == 0)
      four_counters_.Receive(signal.signal, state, out);
    else
      safra_.Receive(signal.signal, state, out);
    for (const Signal& one : out) mail_.Post(one.to, kSignal, DetectorSignal{signal.detector, one});
    if (EndIsFound()) End();
  }

  /// What was found goes to the assembling rank; that waits for all.
  void Finish() {
    SendFound();
    Record();
    if (!assembly_) {
      mail_.Post(assembling_, kLast, std::span<const std::byte>());
    } else {
      Mark(Moment::kAssembleBegins);
      while (assembly_->finished < choice_.holders - 1) TakeLetter(true);
    }
    while (!HasAllCredits()) TakeLetter(true);  // no letter may be left
  }
  bool HasAllCredits() const {
    return std::ranges::all_of(
        neighbours_, [](const Neighbour<Real>& neighbour) { return neighbour.under_way.empty(); });
  }

  const World& world_;
  Mail& mail_;
  RankTracer<Real>& tracer_;
  const DividedChoice& choice_;
  const RayPartitionEntry& row_;
  int assembling_;
  PointSupply supply_;
  RayQueue<Real> queue_;
  std::vector<Neighbour<Real>> neighbours_;
  std::vector<std::uint64_t> waiting_;  // rays for each rank, as far as this one knows
  std::size_t full_here_ = 0;           // packages that cannot be sent yet
  std::vector<Traveller<Real>> more_;
  FoundParts found_;
  std::optional<Assembly> assembly_;
  TravelCounts travel_;
  std::uint64_t packages_received_ = 0;
  FourCounters four_counters_;
  Safra safra_;
  std::size_t worth_sending_;
  bool ended_ = false;
  Progress progress_;
};

/// The bundles that the host still has.
class BundlesLeft {
 public:
  BundlesLeft(const DividedChoice& choice, std::uint32_t count)
      : choice_(choice),
        left_(count),
        taken_(count),
        lists_(static_cast<std::size_t>(choice.holders)) {}

  std::size_t count() const { return left_; }
  /// One for `rank`, while there are some: the first of those that it can follow farthest.
  std::uint32_t Take(int rank) {
    List& list = lists_[static_cast<std::size_t>(rank)];
    if (list.order.empty()) list.order = OrderFor(rank);
    while (taken_[list.order[list.next]]) ++list.next;
    const std::uint32_t bundle = list.order[list.next];
    taken_[bundle] = true;
    --left_;
    return bundle;
  }

 private:
  struct List {
    std::vector<std::uint32_t> order;
    std::size_t next = 0;
  };

  std::vector<std::uint32_t> OrderFor(int rank) const {
    std::vector<std::uint32_t> order(taken_.size());
    std::iota(order.begin(), order.end(), 0U);
    if (choice_.ways.empty()) return order;
    std::vector<std::ptrdiff_t> follows;
    for (const std::vector<std::uint32_t>& way : choice_.ways)
      follows.push_back(
          std::ranges::find_if(
              way, [&](std::uint32_t leaf) { return !choice_.holding->Holds(rank, leaf); }) -
          way.begin());
    std::ranges::stable_sort(order, std::ranges::greater(),
                             [&](std::uint32_t bundle) { return follows[bundle]; });
    return order;
  }

  const DividedChoice& choice_;
  std::size_t left_;
  std::vector<bool> taken_;
  std::vector<List> lists_;  // by rank
};

/// The host: bundles out, what was found in.
[[gnu::noinline]] Raster Serve(Mail& mail, const DividedChoice& choice) {
  MarkHost();
  BundlesLeft left(choice, Bundles(choice.points).count());
  Assembly assembly(choice.points);
  while (assembly.finished < choice.holders) {
    Letter letter;
    mail.Take(true, letter);
    if (letter.tag == kAsk) {
      const bool some = left.count() > 0;
      mail.Post(letter.from, kGiven, some ? left.Take(letter.from) : PointSupply::kNoBundle);
      if (!some) continue;
      RecordBundlesLeft(static_cast<std::uint32_t>(left.count()));
      if (left.count() == 0) Mark(Moment::kSupplyEnds);
    } else if (letter.tag == kFound) {
      assembly.Take(letter.Of<FoundPart>());
    } else if (letter.tag == kLast) {
      ++assembly.finished;
    }
  }
  return assembly.TakeRaster();
}

}  // namespace

template <class Real>
DividedRender RenderDivided(const World& world, RankTracer<Real>* tracer,
                            const DividedChoice& choice) {
  Mark(Moment::kRenderBegins);
  DividedRender divided;
  // Most of what is sent is rays, or what they found; all else is short.
  Mail mail(world, std::max(RayPackage<Real>::MostBytes(choice.package),
                            FoundParts::kMost * sizeof(FoundPart)));
  if (tracer == nullptr) {
    divided.rendered = Rendered(Serve(mail, choice));
  } else {
    Worker<Real> worker(world, mail, *tracer, choice);
    worker.Run();
    divided.rendered = Rendered(worker.TakeRaster());
    divided.rendered.counts = tracer->counts();
    divided.travel = worker.travel();
  }
  divided.rendered.messages = mail.posted();
  return divided;
}

template DividedRender RenderDivided(const World&, RankTracer<float>*, const DividedChoice&);
template DividedRender RenderDivided(const World&, RankTracer<double>*, const DividedChoice&);

}  // namespace stipple::raytracer
