// name: leaks-not-reached
// kind: table
// description: Which leaks does no data get to of the kind that their label names?
// param robot: robot, only this robot; all of them if it is empty, default ""
// returns robot: string, name of the robot
// returns leak: string, name of the leak
// returns category: string, the kind that the label names; no narrower, broader or overlapping one gets there either
// returns label: string, file:line of the label
// order: robot, leak, category, label
MATCH (e:Element)-[l:LEAKS]->(c:DataCategory)
WHERE ($robot = '' OR e.robot = $robot)
  AND NOT EXISTS {  // a kind that data of the finding's may be, and that the label means
    (c)<-[:BROADER*0..]-()-[:BROADER*0..]->(:DataCategory)<-[:OF_CATEGORY]-(:Finding {kind: 'disclosure'})-[:TO]->(e)
  }
RETURN DISTINCT e.robot AS robot, e.name AS leak, c.name AS category,
       coalesce(l.file + ':' + l.line, 'by hand') AS label
ORDER BY robot, leak, category, label
