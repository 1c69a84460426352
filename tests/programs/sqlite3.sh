# SPDX-License-Identifier: MIT
# A database (C, one file of 240 000 lines) with its TCL tests, each test one outcome. Which scripts is the list below:
# queries, joins, triggers, transactions, journals, collations, Unicode, errors injected into memory and files. Left out:
# the other thousand scripts of `veryquick`, which take an hour with recording, and tests that look at times.
packages=(sqlite3)

scripts="select1 select4 join where2 index insert update delete trans trigger1 trigger2 view savepoint conflict collate1
  func expr date cast utf16align attach vacuum pager1 btree01 wal malloc ioerr2 window1 with1 json101 fts3aa rtree1"

build() {
  cd sqlite3 || return
  CC="$cc" CFLAGS="$flags -w" ./configure --disable-static-shell --enable-json1 --disable-shared --with-tcl=/usr/lib/tcl8.6
  make -j2 testfixture
}

suite() {
  local script
  cd sqlite3 || return
  for script in $scripts; do
    ./testfixture "test/$script.test" 2>&1 | grep -E '\.\.\. |\.\.\.$|^!|^[0-9]+ errors' | sed -E 's/ in [0-9.]+ seconds//'
    echo "$script status ${PIPESTATUS[0]}"
  done
}
