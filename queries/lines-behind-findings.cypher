// name: lines-behind-findings
// kind: table
// description: Which policy lines stand behind the shortest paths of the most findings?
// param robot: robot, only what begins or ends at this robot; all robots if it is empty, default ""
// returns findings: integer, how many findings, without dismissed ones
// returns policy: string, file:line of the policy line
// returns robots: integer, at how many robots these begin or end
// returns categories: list of string, kinds of data that arrive at the leaks of these findings
// order: findings DESC, policy
MATCH (f:Finding {dismissed: false})-[a:ACROSS]->(:Element)
WHERE a.file IS NOT NULL AND ($robot = '' OR f.robot = $robot OR f.leak_robot = $robot)
WITH DISTINCT f, a.file + ':' + a.line AS policy
OPTIONAL MATCH (r:Robot) WHERE r.name IN [f.robot, f.leak_robot] AND r.shared IS NULL
WITH f, policy, r ORDER BY f.category
RETURN count(DISTINCT f) AS findings, policy, count(DISTINCT r) AS robots,
       collect(DISTINCT f.category) AS categories
ORDER BY findings DESC, policy
