// name: derivations
// kind: path
// description: Which node makes one kind of data of another, from which source, along which path?
// param robot: robot, only what is made at this robot or of its data; all robots if it is empty, default ""
// returns robot: string, name of the robot of the node
// returns category: string, the kind of data that is made
// returns of: list of string, the categories of which labels say that the node makes it
// returns node: string, who makes it
// returns source: string, where that comes in of which it is made
// returns behind_leak: boolean, whether every path there goes through a leak of the category that is made
// returns path: list of string, names in the order of the flow, from the source to the node
// returns policy: list of string, file:line of the policy line behind each step
// returns source_robot: string, name of the robot of the source, which may be another one
// order: robot, category, node, source, source_robot
MATCH (n:Element)-[d:DERIVES_FROM]->(s:Element)
WHERE $robot = '' OR n.robot = $robot OR s.robot = $robot
RETURN n.robot AS robot, d.category AS category,
       COLLECT { MATCH (n)-[m:DERIVES]->(:DataCategory {name: d.category})
                 RETURN DISTINCT m.of AS of ORDER BY of } AS of,
       n.name AS node, s.name AS source, d.past_leak AS behind_leak, d.way AS path,
       [line IN d.policy | CASE line WHEN '' THEN 'wildcard' ELSE line END] AS policy, s.robot AS source_robot
ORDER BY robot, category, node, source, source_robot
