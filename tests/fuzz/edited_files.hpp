// Files of binary formats, fuzzed by edits: a sound one is changed as lines of text say, and read.
// Changed bytes would try HDF5 and SQLite, and hardly ever what is made of their contents.
#pragma once

#include <string>

namespace qsmpc::testing {

/// A trace, of three periods of the scenario that edited_files.cpp has, after these edits, read and
/// shown in every way. A line is one edit, and one that makes no sense is left out:
///
///     set PATH INDEX VALUE            an element of a dataset, counted along the last dimension
///     rows PATH COUNT                 the length of a dataset's first dimension
///     shape PATH LENGTH…              a dataset of zeros with these dimensions in its place
///     drop PATH                       no such group or dataset
///     text OBJECT ATTRIBUTE VALUE     an attribute that is a text
///     integer OBJECT ATTRIBUTE VALUE  an attribute that is an integer
///     scenario OLD => NEW             NEW for the first OLD in the recorded scenario
///
/// Throws what a reader throws that is no refusal.
void read_edited_trace(const std::string& edits);

/// A campaign's store, of two variants and three seeds, after these edits, read and shown in every
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
