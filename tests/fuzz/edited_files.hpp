// Binary files fuzzed by edits: a sound file is edited as lines of text say, then read. Mutated
// bytes would test HDF5 and SQLite, and hardly ever the code that uses their contents.
#pragma once

#include <string>

namespace qsmpc::testing {

/// Reads a trace after these edits and shows it in every way; the trace has three periods of the
/// scenario in example_drive.hpp. Each line is one edit; a line that makes no sense is skipped:
///
///     set PATH INDEX VALUE            an element of a dataset, counted along the last dimension
///     rows PATH COUNT                 the length of a dataset's first dimension
///     shape PATH LENGTH…              a dataset of zeros with these dimensions in its place
///     drop PATH                       no such group or dataset
///     text OBJECT ATTRIBUTE VALUE     an attribute that is a text
///     integer OBJECT ATTRIBUTE VALUE  an attribute that is an integer
///     scenario OLD => NEW             NEW for the first OLD in the recorded scenario
///
/// Throws whatever a reader throws other than a refusal.
void read_edited_trace(const std::string& edits);

/// Reads a campaign store of two variants and three seeds after these edits and shows it in every
/// way:
///
///     set TABLE COLUMN ROW VALUE      a cell, ROW counted from 0; VALUE may be `null`
///     delete TABLE ROW
///     copy TABLE ROW COLUMN VALUE     a row once more, with another value in one column
///     drop TABLE
///     rename TABLE COLUMN NEW
///     scenario OLD => NEW             NEW for every OLD in the recorded scenarios
///     version NUMBER                  of the schema
///
/// Throws as above.
void read_edited_store(const std::string& edits);

}  // namespace qsmpc::testing
