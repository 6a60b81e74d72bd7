// name: lines-behind-findings
// kind: table
// description: Which policy lines stand behind the shortest paths of the most findings?
// param robot: robot, only this robot; all of them if it is empty, default ""
// returns findings: integer, how many findings, without dismissed ones
// returns policy: string, file:line of the policy line
// returns robots: integer, on how many robots
// returns categories: list of string, kinds of data that arrive at the leaks of these findings
// order: findings DESC, policy
MATCH (f:Finding {dismissed: false})-[a:ACROSS]->(:Element)
WHERE a.file IS NOT NULL AND ($robot = '' OR f.robot = $robot)
WITH DISTINCT f, a.file + ':' + a.line AS policy ORDER BY f.category
RETURN count(f) AS findings, policy, count(DISTINCT f.robot) AS robots, collect(DISTINCT f.category) AS categories
ORDER BY findings DESC, policy
