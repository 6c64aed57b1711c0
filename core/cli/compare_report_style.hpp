// The look of the comparison's page.
#pragma once

namespace sardf {

/// A style sheet for light and dark screens, narrow and wide ones, and paper.
extern const char* const report_style;

}  // namespace sardf
