// name: verdicts
// kind: count
// description: How many robots, and how many parts of the infrastructure, have which verdict, in which view, and with which doubts?
// returns verdict: string, leak, undetermined or no-leak-found
// returns view: string, declared or enforced
// returns robots: integer, how many
// returns some_robots: list of string, the first five of them
// returns part: string, robot, infrastructure, or fleet for what the fleet file states outside ROS
// returns doubts: list of string, what is not known of them, or rests on more than a person's word; the first twenty
// returns number_of_doubts: integer, how many these are in all
// order: verdict, view, part
MATCH (r:Robot)
WHERE coalesce(r.part, 'robot') <> 'domain'  // data passes there, it is nobody's verdict
WITH r ORDER BY r.name
WITH r.verdict AS verdict, r.view AS view, coalesce(r.part, 'robot') AS part, collect(r) AS those
CALL (those) {
  UNWIND those AS r
  UNWIND r.doubts AS doubt
  WITH DISTINCT doubt ORDER BY doubt
  RETURN collect(doubt) AS doubts
}
RETURN verdict, view, size(those) AS robots, [r IN those[..5] | r.name] AS some_robots, part,
  doubts[..20] AS doubts, size(doubts) AS number_of_doubts
ORDER BY verdict, view, part
