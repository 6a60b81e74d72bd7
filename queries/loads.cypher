// name: loads
// kind: table
// description: What was loaded when, by which version, and did it come to its end?
// returns at: string, when the load began, in UTC
// returns state: string, whole once all was written; running until then, and for good where it was cut off
// returns version: string, of rosprivacy
// returns written: integer, how many robots it wrote, and what they share
// returns unchanged: integer, how many were there already as they are
// returns new_robots: list of string, the first twenty robots of those that it wrote for the first time
// returns changes: integer, how many findings came, went or stand otherwise
// order: at
MATCH (l:Load)
CALL (l) {
  MATCH (l)-[w:WROTE]->(r:Robot) WHERE w.version = 1
  WITH r.name AS name ORDER BY name LIMIT 20
  RETURN collect(name) AS new_robots
}
RETURN l.at AS at, l.state AS state, l.version AS version, l.written AS written, l.unchanged AS unchanged, new_robots,
       COUNT { (l)<-[:CAME_WITH]-(:Change) } AS changes
ORDER BY at
