// name: wildcards-on-leak-paths
// kind: table
// description: Which names with wildcards lie on the shortest paths of findings, and which policy line grants them?
// param robot: robot, only its wildcards, and of others the findings that begin or end there; all if it is empty, default ""
// returns findings: integer, how many findings, without dismissed ones
// returns robot: string, name of the robot of the channel; a DDS domain has its own
// returns kind: string, kind of the channel
// returns wildcard: string, the name with wildcards
// returns policy: string, file:line of the line that grants it
// returns categories: list of string, kinds of data that arrive at the leaks of these findings
// order: findings DESC, robot, kind, wildcard, policy
MATCH (f:Finding {dismissed: false})-[a:ACROSS]->(w:Wildcard)
WHERE $robot = '' OR $robot IN [w.robot, f.robot, f.leak_robot]
OPTIONAL MATCH (f)-[b:ACROSS {step: a.step + 1}]->(:Element)  // to or from a wildcard; what it matches has no line
UNWIND [s IN [a, b] WHERE s.file IS NOT NULL | s.file + ':' + s.line] AS policy
WITH DISTINCT f, w.robot AS robot, w.kind AS kind, w.name AS wildcard, policy ORDER BY f.category
RETURN count(f) AS findings, robot, kind, wildcard, policy, collect(DISTINCT f.category) AS categories
ORDER BY findings DESC, robot, kind, wildcard, policy
