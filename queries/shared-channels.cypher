// name: shared-channels
// kind: table
// description: Which channels lie on the shortest paths of several findings, so that a change there closes most?
// param least: integer, fewest findings, default 2
// param robot: robot, only its channels, and of others the findings that begin or end there; all if it is empty, default ""
// returns findings: integer, how many findings have it on their shortest path, without dismissed ones
// returns robot: string, name of the robot of the channel; a DDS domain has its own
// returns kind: string, topic, service or action
// returns channel: string, name of the channel
// returns categories: list of string, kinds of data that arrive at the leaks of these findings
// returns sources: integer, how many sources these have
// returns leaks: integer, how many leaks
// order: findings DESC, robot, kind, channel
MATCH (f:Finding {dismissed: false})-[:ACROSS]->(e:Topic|Service|Action)
WHERE $robot = '' OR $robot IN [e.robot, f.robot, f.leak_robot]
WITH DISTINCT f, e.robot AS robot, e.kind AS kind, e.name AS channel ORDER BY f.category
WITH robot, kind, channel, count(f) AS findings, collect(DISTINCT f.category) AS categories,
     count(DISTINCT f.source) AS sources, count(DISTINCT f.leak) AS leaks
WHERE findings >= $least
RETURN findings, robot, kind, channel, categories, sources, leaks
ORDER BY findings DESC, robot, kind, channel
