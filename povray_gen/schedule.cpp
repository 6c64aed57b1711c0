#include "povray_gen/schedule.hpp"

#include <algorithm>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

#include "sardf/error.hpp"

namespace sardf::povray {

namespace {

using Items = std::vector<ScopeItem>;

void set_levels(Items& items) {
  for (ScopeItem& item : items) {
    item.level = 0;
    for (int used : item.items) {
      item.level = std::max(item.level, items[used].level + (items[used].shared ? 1 : 0));
    }
  }
}

// The most values alive between two steps, of values made at step `made` (-1: from outside) and
// last used at step `last`.
class LiveCount {
 public:
  explicit LiveCount(int steps) : change_(size_t(steps) + 2, 0) {}
  void add(int made, int last) {
    if (last <= made) return;
    ++change_[made + 1];
    --change_[last + 1];
  }
  /// By step: the values made before it and used in it or later.
  std::vector<int> before() const {
    std::vector<int> out(change_.size());
    std::partial_sum(change_.begin(), change_.end(), out.begin());
    return out;
  }

 private:
  std::vector<int> change_;
};

// Each shared value as early as the values that it needs allow, all else in the text of its user:
// the shortest chain.
Schedule by_level(const Items& items, int free_count, int most) {
  Schedule out;
  const int n = int(items.size());
  out.stages = items.back().level;
  out.stage.assign(n, -1);
  std::vector<int> printed(n, out.stages), last(n, -1), last_free(free_count, -1);
  for (int i = n - 1; i >= 0; --i) {
    if (items[i].shared) printed[i] = out.stage[i] = items[i].level;
    for (int used : items[i].items) {
      printed[used] = printed[i];  // of a term that is not shared, this is the only user
      last[used] = std::max(last[used], printed[i]);
    }
    for (int used : items[i].free) last_free[used] = std::max(last_free[used], printed[i]);
  }
  LiveCount live(out.stages);
  for (int i = 0; i < n; ++i) {
    if (items[i].shared) live.add(out.stage[i], last[i]);
  }
  for (int at : last_free) live.add(-1, at);
  const std::vector<int> before = live.before();
  // Stage 0 stands in the caller and has no parameters of its own.
  for (int stage = 1; stage <= out.stages; ++stage) {
    if (before[stage] > most) return {};
  }
  return out;
}

// An order in which few values are alive at a time: what frees most comes first, then what uses
// something that is there already.
std::vector<int> order_of_least_pressure(const Items& items) {
  const int n = int(items.size());
  std::vector<int> missing(n), remaining_uses(n, 0), order, ready;
  std::vector<std::vector<int>> users(n);
  for (int i = 0; i < n; ++i) {
    missing[i] = int(items[i].items.size());
    for (int used : items[i].items) {
      ++remaining_uses[used];
      users[used].push_back(i);
    }
    if (missing[i] == 0) ready.push_back(i);
  }
  const auto freed = [&](int item) {
    return std::count_if(items[item].items.begin(), items[item].items.end(),
                         [&](int used) { return remaining_uses[used] == 1; });
  };
  while (!ready.empty()) {
    const auto best = std::max_element(ready.begin(), ready.end(), [&](int a, int b) {
      return std::tuple(freed(a), !items[a].items.empty(), -a) <
             std::tuple(freed(b), !items[b].items.empty(), -b);
    });
    const int item = *best;
    ready.erase(best);
    order.push_back(item);
    for (int used : items[item].items) --remaining_uses[used];
    for (int user : users[item]) {
      if (--missing[user] == 0) ready.push_back(user);
    }
  }
  return order;
}

// Every term is computed as soon as its turn comes, in the order of blocks of `base` and of levels
// inside a block; the chain is cut where a shared value is first used. Wide sums, whose terms all
// wait for the end in by_level, become running sums.
Schedule in_blocks(const Items& items, const std::vector<int>& base, int free_count, int most,
                   int block) {
  const int n = int(items.size());
  std::vector<int> order(base), rank(n), at(n), last(n, -1), last_free(free_count, -1);
  for (int p = 0; p < n; ++p) rank[base[p]] = p;
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return std::pair(rank[a] / block, items[a].level) < std::pair(rank[b] / block, items[b].level);
  });
  for (int p = 0; p < n; ++p) at[order[p]] = p;
  for (int i = 0; i < n; ++i) {
    for (int used : items[i].items) last[used] = std::max(last[used], at[i]);
    for (int used : items[i].free) last_free[used] = std::max(last_free[used], at[i]);
  }
  LiveCount live(n);
  for (int i = 0; i < n; ++i) live.add(at[i], last[i]);
  for (int p : last_free) live.add(-1, p);
  const std::vector<int> before = live.before();

  std::vector<int> segment(n, 0);
  int start = 0, number = 0;
  for (int p = 0; p < n; ++p) {
    int conflict = -1;
    for (int used : items[order[p]].items) {
      if (items[used].shared && at[used] >= start) conflict = std::max(conflict, at[used]);
    }
    if (conflict >= 0) {
      int cut = p;
      for (int q = p; q > conflict && before[cut] > most; --q) {
        if (before[q] < before[cut]) cut = q;
      }
      if (before[cut] > most) return {};
      start = cut;
      ++number;
      for (int q = cut; q < p; ++q) segment[order[q]] = number;
    }
    segment[order[p]] = number;
  }
  Schedule out;
  out.stages = number;
  out.stage.assign(n, -1);
  for (int i = 0; i < n; ++i) {
    for (int used : items[i].items) {
      if (items[used].shared || segment[used] < segment[i]) out.stage[used] = segment[used];
    }
  }
  return out;
}

}  // namespace

Schedule schedule(std::vector<ScopeItem>& items, int free_count, int most_parameters) {
  set_levels(items);
  Schedule found = by_level(items, free_count, most_parameters);
  if (!found.stage.empty()) return found;
  const int n = int(items.size());
  std::vector<int> as_written(n);
  std::iota(as_written.begin(), as_written.end(), 0);
  for (const auto& base : {as_written, order_of_least_pressure(items)}) {
    for (int block = n; block >= 1; block /= 2) {
      found = in_blocks(items, base, free_count, most_parameters, block);
      if (!found.stage.empty()) return found;
    }
  }
  throw Error("a formula needs more than " + std::to_string(most_parameters) +
              " intermediate values at once; POV-Ray functions have at most that many parameters");
}

}  // namespace sardf::povray
