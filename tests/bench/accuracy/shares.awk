# SPDX-License-Identifier: MIT
# awk -f shares.awk PLANTED_OUTPUT PROFILE_CSV: of each region over 1 % of the links
#   NAME TRUE_SHARE SHARE ERROR INTERVAL CALLS       shares of all planted regions' time; error and half interval relative
# The planted work is a number of links; whatever slows all of them down alike cancels out in shares.
FNR == NR { if ($1 == "region") { links[$2] = $3; all += $3 } next }
{
  n = split($0, f, ",")
  if (!(f[1] in links)) next
  calls[f[1]] = f[4]; time[f[1]] = f[6]; low[f[1]] = f[7]; high[f[1]] = f[8]; total += f[6]
}
END {
  for (r in links) {
    truth = links[r] / all
    if (truth < 0.01) continue
    if (total <= 0) total = 1e-9
    share = time[r] / total
    # As far as the truth is above (or below) the time, the upper (or lower) bound counts.
    half = share < truth ? high[r] - time[r] : time[r] - low[r]
    printf("%s %.6f %.6f %.6f %.6f %d\n", r, truth, share, share / truth - 1, half / total / truth, calls[r])
  }
}
