// name: verdicts
// kind: count
// description: How many robots, and how many parts of the infrastructure, have which verdict, in which view?
// returns verdict: string, leak, undetermined or no-leak-found
// returns view: string, declared or enforced
// returns robots: integer, how many
// returns some_robots: list of string, the first five of them
// returns part: string, robot, infrastructure, or fleet for what the fleet file states outside ROS
// order: verdict, view, part
MATCH (r:Robot)
WHERE coalesce(r.part, 'robot') <> 'domain'  // data passes there, it is nobody's verdict
WITH r ORDER BY r.name
WITH r.verdict AS verdict, r.view AS view, coalesce(r.part, 'robot') AS part, collect(r.name) AS names
RETURN verdict, view, size(names) AS robots, names[..5] AS some_robots, part
ORDER BY verdict, view, part
