// In which stage of a scope each of its values is computed.
#pragma once

#include <vector>

namespace sardf::povray {

/// One term of a scope that may be computed on its own.
struct ScopeItem {
  int term = -1;
  bool shared = false;     // used more than once: must be a value
  std::vector<int> items;  // positions of the items that it uses; all smaller than its own
  std::vector<int> free;   // values from outside that it uses: numbers from 0
  int level = 0;           // shared items on the longest way below it; set by schedule()
};

struct Schedule {
  /// For each item the stage in whose call it is computed, or -1: inside the text of its user.
  std::vector<int> stage;
  int stages = 0;
};

/// A schedule in which no stage has more than `most_parameters` parameters. The last item is the
/// scope's result, computed in the last stage. `free_count`: how many values come from outside.
/// Throws Error if there is none.
Schedule schedule(std::vector<ScopeItem>& items, int free_count, int most_parameters);

}  // namespace sardf::povray
