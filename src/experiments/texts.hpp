#pragma once

namespace raytruth {

/// Texts that the build puts into the program as they are (src/cmake/embed.cmake).

extern const char* const plot_script;         ///< plot.py, which draws results with matplotlib
extern const char* const claims_text;         ///< claims.json: every testable claim of the five publications
extern const char* const criteria_text;       ///< criteria.json: what decides a verdict, by kind of sentence
extern const char* const ledger_page_script;  ///< ledger_page.py, which makes a page for people of the ledger

}  // namespace raytruth
