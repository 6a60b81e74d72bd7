// name: verdicts
// kind: count
// description: How many robots have which verdict, in which view?
// returns verdict: string, leak, undetermined or no-leak-found
// returns view: string, declared or enforced
// returns robots: integer, how many
// returns some_robots: list of string, the first five of them
// order: verdict, view
MATCH (r:Robot) WHERE r.shared IS NULL
WITH r ORDER BY r.name
WITH r.verdict AS verdict, r.view AS view, collect(r.name) AS names
RETURN verdict, view, size(names) AS robots, names[..5] AS some_robots
ORDER BY verdict, view
