#pragma once

namespace CLI {
class App;
}

namespace sardf {

/// `sardf compare-images REFERENCE CANDIDATE -o report.html`. Ends with CLI::RuntimeError(1) where
/// the pictures do not agree; throws Error for files that cannot be compared.
void add_compare_images(CLI::App& app);

}  // namespace sardf
