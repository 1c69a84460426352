// SPDX-License-Identifier: MIT
// What lands on disk, version 1. Written by runtime/, read by analysis/trace; docs/format.md says
// the same in prose.
//
// An archive is a directory NAME.stipple with one stream file HOSTNAME.PID.START.stream per
// process. A stream file is a FileHeader, then chunks, each a multiple of kGranuleBytes and aligned
// to it; bytes never written are zero. A chunk is a ChunkHeader, then words. A word that is zero
// was never committed. Any other word is either a function event (8 bytes) or the header of an
// extended record, told apart by the low 23 bits. Little-endian throughout. Values once used are
// never reused; zero means "not written yet".
#ifndef STIPPLE_FORMAT_H
#define STIPPLE_FORMAT_H

// IWYU pragma: begin_exports
#include "stipple/format/definitions.h"
#include "stipple/format/events.h"
#include "stipple/format/words.h"
// IWYU pragma: end_exports

#endif
