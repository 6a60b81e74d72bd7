// name: findings-by-data-type
// kind: table
// description: Which findings are of data that is represented in some way, such as video, audio or position?
// param type: data type, image, video, audio, position or another one; all of them if it is empty, default ""
// param robot: robot, only what begins or ends at this robot; all robots if it is empty, default ""
// returns type: string, how the data is represented; 'not stated' where the ontology says none of the kind, which may be any
// returns robot: string, name of the robot of the source
// returns category: string, the kind of data that arrives
// returns source: string, where the data comes in
// returns leak: string, where it gets out
// returns article9: string, strongest verdict under Article 9(1) GDPR
// returns leak_robot: string, name of the robot of the leak, which may be another one
// returns may_be: boolean, whether the data only may be of the type asked for: a narrower kind is
// order: type, robot, category, source, leak, leak_robot
MATCH (c:DataCategory)
WITH c, size(coalesce(c.data_types, [])) = 0 AS unknown
WITH c, unknown, $type <> '' AND NOT unknown AND NOT $type IN c.data_types
     AND EXISTS { (c)<-[:BROADER*1..]-(n) WHERE size(coalesce(n.data_types, [])) = 0 OR $type IN n.data_types } AS may_be
UNWIND CASE WHEN unknown THEN ['not stated'] WHEN may_be THEN [$type] ELSE c.data_types END AS type
WITH c, type, may_be WHERE $type = '' OR type IN [$type, 'not stated']
MATCH (c)<-[:OF_CATEGORY]-(f:Finding {dismissed: false})
WHERE $robot = '' OR f.robot = $robot OR f.leak_robot = $robot
RETURN type, f.robot AS robot, f.category AS category, f.source AS source, f.leak AS leak,
       c.article9 AS article9, f.leak_robot AS leak_robot, may_be
ORDER BY type, robot, category, source, leak, leak_robot
